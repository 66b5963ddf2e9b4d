// SPDX-License-Identifier: MIT
/// Closed triangle meshes.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::importing {

struct Triangles {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<uint32_t, 3>> corners;  ///< counter-clockwise seen from outside
};

/// [main] Reverses all triangles if the surface is inside out. Fails for a surface with a hole, with an edge of more
/// than two triangles, or without volume, because then it is not defined which points are inside.
Result<void> orientClosed(Triangles& mesh, const std::string& file);

}  // namespace hapticd::importing
