// SPDX-License-Identifier: MIT
/// Meshes made by hand, for tests.
#pragma once
#include <array>
#include <map>
#include <vector>

#include "sample_solids.hpp"

namespace hapticd::brep::samples {

/// The corners [m] of triangles, counter-clockwise seen from outside.
using TriangleList = std::vector<std::array<Vector3d, 3>>;

/// Returns the closed part of a mesh whose triangles share corners with the same numbers.
inline Part partOf(const TriangleList& mesh) {
  Part part;
  std::map<std::array<double, 3>, std::uint32_t> points;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> sides;  // the side of a triangle from one point to another
  for (const auto& corners : mesh) {
    Triangle t;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d& p = corners[k];
      const auto [found, added] =
          points.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(part.points.size()));
      if (added) part.points.push_back({p.x(), p.y(), p.z()});
      t.corner[k] = found->second;
    }
    for (std::uint32_t k = 0; k < 3; ++k)
      sides[{t.corner[k], t.corner[(k + 1) % 3]}] = 4 * static_cast<std::uint32_t>(part.triangles.size()) + k;
    part.triangles.push_back(t);
  }
  for (Triangle& t : part.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const auto found = sides.find({t.corner[(k + 1) % 3], t.corner[k]}); found != sides.end())
        t.across[k] = found->second;
  endBody(part, BodyKind::kMesh, kClosed);
  return part;
}

}  // namespace hapticd::brep::samples
