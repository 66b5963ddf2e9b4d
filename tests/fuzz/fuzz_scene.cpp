// SPDX-License-Identifier: MIT
/// Fuzzes scene, device and daemon files, and kinematic paths.
#include <algorithm>

#include "host/catalog.hpp"
#include "scene/kinematic_path.hpp"
#include "scene/load.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  // The reader limits the number of values that nested aliases make, but up to this limit it takes half a minute under
  // the sanitizers. So inputs with many aliases are skipped.
  constexpr auto kMostAliases = 24;
  static hapticd::host::Catalog catalog({{TEST_MODULES "/good"}, {TEST_MODULES "/good"}});
  const std::string text(reinterpret_cast<const char*>(data), size);
  if (std::count(text.begin(), text.end(), '*') > kMostAliases) return 0;
  hapticd::scene::checkText(text, "fuzz.yaml", catalog);
  hapticd::document::Problems problems;
  hapticd::scene::parseKinematicPath(text, "fuzz.csv", problems);
  return 0;
}
