// SPDX-License-Identifier: MIT
#include "kernels/medial/foot_motion.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "kernels/medial/bounds.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kFlat = 1e-9;  ///< share of the trace; a smaller curvature counts as zero

/// Solves h x = g for the parameters that are not held.
std::array<Vector3d, 2> solve(const Matrix2d& h, const std::array<Vector3d, 2>& g, const std::array<bool, 2>& held) {
  std::array<Vector3d, 2> x{Vector3d::Zero(), Vector3d::Zero()};
  const double least = kFlat * (std::fabs(h(0, 0)) + std::fabs(h(1, 1)));
  if (held[0] || held[1]) {
    for (std::size_t a = 0; a < 2; ++a) {
      const double curvature = h(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(a));
      if (!held[a] && curvature > least) x[a] = g[a] / curvature;
    }
    return x;
  }
  const double det = h.determinant();
  if (!(det > least * least) || !(h(0, 0) > 0)) return x;
  x[0] = (h(1, 1) * g[0] - h(0, 1) * g[1]) / det;
  x[1] = (h(0, 0) * g[1] - h(1, 0) * g[0]) / det;
  return x;
}

}  // namespace

FootMotion footMotion(const Skeleton& skeleton, const Vector3d& p, const SkeletonFoot& foot, const Vector3d& normal,
                      Envelope envelope, double direct) noexcept {
  FootMotion motion;
  spline::SurfacePoint s;
  skeleton.surface().evaluate2(foot.u, foot.v, s);
  const Vector3d d = p - foot.center;
  const double distance = d.norm();
  const bool exact = envelope == Envelope::kExact && !skeleton.radius().constant();
  const ScalarField::Value r = exact ? skeleton.radius().evaluate2(foot.u, foot.v) : ScalarField::Value{};
  const std::array<Vector3d, 2> tangent{s.Su, s.Sv};
  const std::array<double, 2> at{foot.u, foot.v}, slope{r.fu, r.fv};
  direct *= std::clamp(distance / kNearAxis - 1, 0.0, 1.0);
  std::array<bool, 2> held{skeleton.curve(), false};
  std::array<Vector3d, 2> aside;
  for (std::size_t a = 0; a < 2; ++a) {
    const auto& range = skeleton.parameters()[a];
    const double pull = tangent[a].dot(normal) + slope[a];
    held[a] = held[a] || (at[a] <= range.front() && pull <= 0) || (at[a] >= range.back() && pull >= 0);
    // If `normal` is not the direction from the foot, it does not say how the foot moves; the foot then moves as on a
    // flat skeleton.
    aside[a] = tangent[a] - direct * tangent[a].dot(normal) * normal;
  }
  Matrix2d h;
  h << aside[0].dot(aside[0]), aside[0].dot(aside[1]), aside[0].dot(aside[1]), aside[1].dot(aside[1]);
  if (direct > 0) {
    const double bent = direct * distance;
    h(0, 0) -= bent * (normal.dot(s.Suu) + r.fuu);
    h(0, 1) -= bent * (normal.dot(s.Suv) + r.fuv);
    h(1, 0) = h(0, 1);
    h(1, 1) -= bent * (normal.dot(s.Svv) + r.fvv);
    motion.turn = direct / distance;
  }
  const std::array<Vector3d, 2> toward = solve(h, aside, held);
  motion.toward_u = toward[0];
  motion.toward_v = toward[1];
  motion.tangent_u = s.Su;
  motion.tangent_v = s.Sv;
  return motion;
}

}  // namespace hapticd::medial
