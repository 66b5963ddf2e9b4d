// SPDX-License-Identifier: MIT
/// Any bytes as a scene, device or daemon file, and as a kinematic path.
#include <algorithm>

#include "host/catalog.hpp"
#include "scene/kinematic_path.hpp"
#include "scene/load.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  // Aliases of aliases are stopped at a count of values that takes half a minute under the sanitizers.
  constexpr auto kMostAliases = 24;
  static hapticd::host::Catalog catalog({{TEST_MODULES "/good"}, {TEST_MODULES "/good"}});
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (std::count(text.begin(), text.end(), '*') > kMostAliases) return 0;
  hapticd::scene::checkText(text, "fuzz.yaml", catalog);
  hapticd::document::Problems problems;
  hapticd::scene::parseKinematicPath(text, "fuzz.csv", problems);
  return 0;
}
