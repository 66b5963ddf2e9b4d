// SPDX-License-Identifier: MIT
/// Closed triangle meshes from OBJ and STL files.
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

/// [main] Reads an OBJ (v and f; polygons are cut into triangles) or an STL (text or binary; equal points become one).
/// Errors give the line if there are lines.
Result<Triangles> parseObj(const std::string& text, const std::string& file);
Result<Triangles> parseStl(const std::string& bytes, const std::string& file);

/// [main] Reverses all triangles if the surface is inside out. Fails for a surface with a hole, with an edge of more
/// than two triangles, or without volume, because then it is not defined which points are inside.
Result<void> orientClosed(Triangles& mesh, const std::string& file);

}  // namespace hapticd::importing
