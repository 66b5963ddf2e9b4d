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
};

}  // namespace hapticd
