// SPDX-License-Identifier: MIT
#include "kernels/trace/side_curve.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hapticd::trace {

using Eigen::Array2d;
using Eigen::Vector3d;

Vector3d pointOnSide(const Patch& patch, int side, double fraction) noexcept {
  const Array2d uv = patch.onSide(side, fraction);
  spline::SurfacePoint E;
  patch.surface.evaluate1(uv[0], uv[1], E);
  return E.S;
}

double nearestFraction(const Patch& patch, int side, const Vector3d& p, double start) noexcept {
  constexpr int kSteps = 12;
  const int along = 1 - Patch::axisOf(side);
  const double range = patch.hi[along] - patch.lo[along];
  double t = std::clamp(start, 0.0, 1.0);
  double best = t, best_distance2 = -1;
  for (int i = 0; i < kSteps; ++i) {
    const Array2d uv = patch.onSide(side, t);
    spline::SurfacePoint E;
    patch.surface.evaluate2(uv[0], uv[1], E);
    const Vector3d r = E.S - p;
    if (best_distance2 >= 0 && r.squaredNorm() > best_distance2) {
      t = 0.5 * (t + best);  // the new point is farther: halve the step
      continue;
    }
    best = t;
    best_distance2 = r.squaredNorm();
    const Vector3d C1 = range * (along == 0 ? E.Su : E.Sv), C2 = range * range * (along == 0 ? E.Suu : E.Svv);
    const double first_order = C1.squaredNorm(), second_order = first_order + r.dot(C2);
    const double slope = r.dot(C1);
    const double curvature = second_order > 0.1 * first_order ? second_order : first_order;
    if (!(curvature > 0)) break;
    const double next = std::clamp(t - slope / curvature, 0.0, 1.0);
    if (std::abs(next - t) < 1e-15) break;
    t = next;
  }
  return best;
}

PoleFan fanOf(const Patch& patch, int side) noexcept {
  // parameter distance from the pole, as a share of the range; the direction to a point there is defined even if the
  // tangent at the pole vanishes
  constexpr double kInward = 1e-3;
  PoleFan fan;
  const int axis = Patch::axisOf(side);
  const double inward = (side % 2 == 0 ? 1 : -1) * kInward * (patch.hi[axis] - patch.lo[axis]);
  spline::SurfacePoint apex, E;
  for (int i = 0; i < PoleFan::kRays; ++i) {
    const auto ray = static_cast<std::size_t>(i);
    Array2d uv = patch.onSide(side, i / (PoleFan::kRays - 1.0));
    fan.along[ray] = uv[1 - axis];
    patch.surface.evaluate1(uv[0], uv[1], apex);
    uv[axis] += inward;
    patch.surface.evaluate1(uv[0], uv[1], E);
    fan.direction[ray] = (E.S - apex.S).normalized();
    fan.speed[ray] = (E.S - apex.S).norm() / std::abs(inward);
  }
  return fan;
}

Vector3d fanNormal(const Patch& patch, int side, const PoleFan& fan) noexcept {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i + 1 < PoleFan::kRays; ++i) {
    const Vector3d &a = fan.direction[i], &b = fan.direction[i + 1];
    const double fraction = (static_cast<double>(i) + 0.5) / (PoleFan::kRays - 1);
    sum += std::atan2(a.cross(b).norm(), a.dot(b)) * patch.normalAt(patch.onSide(side, fraction));
  }
  return sum;
}

double cornerAngle(const Patch& patch, int corner) noexcept {
  constexpr double kAside = 1e-3;  // share of the range; chords of this length are used, because tangents may vanish
  const Array2d range = patch.hi - patch.lo;
  const Array2d at{corner % 2 == 0 ? patch.lo[0] : patch.hi[0], corner / 2 == 0 ? patch.lo[1] : patch.hi[1]};
  const Array2d inward{(corner % 2 == 0 ? kAside : -kAside) * range[0],
                       (corner / 2 == 0 ? kAside : -kAside) * range[1]};
  spline::SurfacePoint apex, one, two;
  patch.surface.evaluate1(at[0], at[1], apex);
  patch.surface.evaluate1(at[0] + inward[0], at[1], one);
  patch.surface.evaluate1(at[0], at[1] + inward[1], two);
  const Vector3d a = one.S - apex.S, b = two.S - apex.S;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace hapticd::trace
