// SPDX-License-Identifier: MIT
/// Fuzzes model files of soft bodies (YAML or JSON, grids or meshes): reads, builds, searches, presses and draws them.

#include "mat_deformable/medial_file.hpp"
#include "mat_deformable/soft_body.hpp"
#include "press_a_body.hpp"
#include "traced_shape/model_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hapticd;
  try {
    const MedialFile file = parseMedialFile({reinterpret_cast<const char*>(data), size}, "fuzz.yaml", {});
    pressABody(file.grid ? *makeSoftBody(*file.grid, {}) : *makeSoftBody(*file.mesh, {}), size);
  } catch (const ModelFileError&) {
  } catch (const std::invalid_argument&) {  // the plugin's error for a body that is impossible
  }
  return 0;
}
