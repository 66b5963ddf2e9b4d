// SPDX-License-Identifier: MIT
/// Fuzzes medial meshes (.ma): reads, builds, searches, presses and draws them.
#include "mat_deformable/medial_file.hpp"
#include "press_a_body.hpp"
#include "traced_shape/model_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hapticd;
  try {
    const MedialFile file = parseMedialFile({reinterpret_cast<const char*>(data), size}, "fuzz.ma", {300, .5, .01});
    pressABody(*makeSoftBody(*file.mesh, {}), size);
  } catch (const ModelFileError&) {
  } catch (const std::invalid_argument&) {  // the plugin's error for a body that is impossible
  }
  return 0;
}
