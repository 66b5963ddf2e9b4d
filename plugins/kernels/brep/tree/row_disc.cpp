// SPDX-License-Identifier: MIT
#include "kernels/brep/tree/row_disc.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/brep/geometry/geometry.hpp"

namespace hapticd::brep {

using Eigen::Vector3d;

RowDisc rowDisc(const Part& part, std::span<const std::uint32_t> triangles, const BoxTree& tree) {
  Vector3d normal(0, 0, 0);
  Eigen::AlignedBox3d box;
  for (const std::uint32_t triangle : triangles) {
    const auto& corner = part.triangles[triangle].corner;
    const Vector3d a = vec(part.points[corner[0]]), b = vec(part.points[corner[1]]), c = vec(part.points[corner[2]]);
    normal += (b - a).cross(c - a);
    for (const Vector3d& p : {a, b, c}) box.extend(p);
  }
  // zero if the triangles have no area or opposite normals; the disc then becomes a ball
  normal = normal.stableNormalized();
  // The disc must enclose the triangles even after rounding to single precision.
  RowDisc disc;
  Vector3d center, n;
  for (int axis = 0; axis < 3; ++axis) {
    disc.center[axis] = static_cast<float>(box.center()[axis] - tree.origin()[axis]);
    disc.normal[axis] = static_cast<float>(normal[axis]);
    center[axis] = tree.origin()[axis] + static_cast<double>(disc.center[axis]);
    n[axis] = static_cast<double>(disc.normal[axis]);
  }
  double half = 0, radius = 0;
  for (const std::uint32_t triangle : triangles)
    for (const std::uint32_t corner : part.triangles[triangle].corner) {
      const Vector3d way = vec(part.points[corner]) - center;
      const double off = way.dot(n);
      half = std::max(half, std::abs(off));
      radius = std::max(radius, std::sqrt(std::max(0.0, way.squaredNorm() - off * off)));
    }
  disc.half = static_cast<float>(half * (1 + 1e-6) + 1e-6 * radius + tree.margin());
  disc.radius = static_cast<float>(radius * (1 + 1e-5) + 1e-6 * half + tree.margin());
  return disc;
}

}  // namespace hapticd::brep
