// SPDX-License-Identifier: MIT
/// Fuzzes the reader of Bezier patches (.bpt).
#include "import/bezier_import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  auto model = hapticd::importing::parseBpt({reinterpret_cast<const char*>(data), size}, "fuzz.bpt");
  if (!model) return 0;
  hapticd::importing::placeModel(*model, {1, 0.1, true, 'z'});
  return hapticd::importing::toModelYaml(*model).empty() || hapticd::importing::toModelJson(*model).empty() ? 1 : 0;
}
