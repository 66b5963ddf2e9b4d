/// Any bytes as a scene, device or daemon file, and as a kinematic path.
#include "host/catalog.hpp"
#include "scene/kinematic_path.hpp"
#include "scene/load.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static hapticd::host::Catalog catalog({{TEST_MODULES "/good"}, {TEST_MODULES "/good"}});
  const std::string text(reinterpret_cast<const char*>(data), size);
  hapticd::scene::checkText(text, "fuzz.yaml", catalog);
  hapticd::scene::Problems problems;
  hapticd::scene::parseKinematicPath(text, "fuzz.csv", problems);
  return 0;
}
