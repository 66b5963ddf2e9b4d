// SPDX-License-Identifier: MIT
/// Any bytes as a medial mesh (.ma): read, built, searched, pressed and drawn.
#include "mat_deformable/medial_file.hpp"
#include "press_a_body.hpp"
#include "traced_shape/model_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hapticd;
  try {
    const MedialFile file = parseMedialFile({reinterpret_cast<const char*>(data), size}, "fuzz.ma", {300, .5, .01});
    pressABody(*makeSoftBody(*file.mesh, {}), size);
  } catch (const ModelFileError&) {
  } catch (const std::invalid_argument&) {  // what the plugin reports of a body that cannot be
  }
  return 0;
}
