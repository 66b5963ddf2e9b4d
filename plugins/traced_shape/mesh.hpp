// SPDX-License-Identifier: MIT
/// Triangles for drawing.
#pragma once
#include <cstdint>
#include <vector>

namespace hapticd {

/// Vertices, normals and triangles of a model, for drawing.
struct Mesh {
  std::vector<float> xyz, normals;
  std::vector<uint32_t> indices;
  std::vector<uint32_t> colours;  ///< of each vertex, as in hsp_mesh; empty if the model has none
};

}  // namespace hapticd
