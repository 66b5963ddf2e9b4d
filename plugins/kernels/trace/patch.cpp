// SPDX-License-Identifier: MIT
#include "kernels/trace/patch.hpp"

#include <Eigen/Geometry>

namespace hapticd::trace {

Eigen::Vector3d Patch::normalAt(const Eigen::Array2d& uv) const noexcept {
  // least |Su x Sv| relative to the largest |Su| |Sv| of the patch; below it the direction is mostly rounding error
  constexpr double kVanishing = 1e-9;
  constexpr int kNudges = 4;
  const Eigen::Array2d middle = 0.5 * (lo + hi);
  double nudge = 1e-4;
  spline::SurfacePoint E;
  surface.evaluate1(uv[0], uv[1], E);
  Eigen::Vector3d n = E.Su.cross(E.Sv);
  const double scale = E.Su.squaredNorm() + E.Sv.squaredNorm();
  for (int i = 0; i < kNudges && !(n.norm() > kVanishing * scale); ++i, nudge *= 10) {
    const Eigen::Array2d inside = uv + nudge * (middle - uv);
    surface.evaluate1(inside[0], inside[1], E);
    n = E.Su.cross(E.Sv);
  }
  const double length = n.norm();
  return length > 0 ? Eigen::Vector3d(n * (sign / length)) : Eigen::Vector3d::UnitZ();
}

}  // namespace hapticd::trace
