// SPDX-License-Identifier: MIT
/// Any bytes as a model file of a soft body, YAML or JSON, a grid or a mesh: read, built, searched, pressed and drawn.

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
  } catch (const std::invalid_argument&) {  // what the plugin reports of a body that cannot be
  }
  return 0;
}
