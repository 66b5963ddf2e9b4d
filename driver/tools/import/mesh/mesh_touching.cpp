// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_touching.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hapticd::importing {

using Eigen::Vector3d;

/// Seen along the edge, a triangle that runs forward has the inside before it and the outside behind it, in the order
/// of the angles, and one that runs backward has them the other way round. Triangles at one angle have no order.
bool solidsTouch(const std::vector<Vector3d>& points, const std::vector<std::array<std::uint32_t, 3>>& corners,
                 const std::vector<MeshEdge>& edges, std::size_t first, std::size_t end) {
  constexpr double kApart = 1e-6;  // [rad]
  if ((end - first) % 2 != 0) return false;
  const Vector3d& a = points[edges[first].ends >> 32];
  const Vector3d along = points[edges[first].ends & 0xffffffffu] - a;
  const Vector3d x = along.unitOrthogonal(), y = along.normalized().cross(x);
  std::vector<std::pair<double, bool>> around;
  for (std::size_t k = first; k < end; ++k) {
    const Vector3d to = points[corners[edges[k].code / 4][(edges[k].code % 4 + 2) % 3]] - a;
    around.emplace_back(std::atan2(to.dot(y), to.dot(x)), runsForward(corners, edges[k]));
  }
  std::sort(around.begin(), around.end());
  for (std::size_t k = 0; k < around.size(); ++k) {
    const auto& [angle, forward] = around[k];
    const bool last = k + 1 == around.size();
    const auto& [next, next_forward] = around[last ? 0 : k + 1];
    if (next + (last ? 2 * std::numbers::pi : 0) - angle < kApart || next_forward == forward) return false;
  }
  return true;
}

}  // namespace hapticd::importing
