// SPDX-License-Identifier: MIT
#include "kernels/trace/curve_foot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::trace {

using Eigen::Vector3d;

double directStep(const spline::CurvePoint& at, const Vector3d& p) noexcept {
  const double speed2 = at.C1.squaredNorm();
  return speed2 > 0 ? (p - at.C).dot(at.C1) / speed2 : 0;
}

CurveFoot directFoot(const spline::Curve& curve, const Vector3d& p, double u, int steps) noexcept {
  const auto [lo, hi] = curve.domain();
  CurveFoot foot;
  spline::CurvePoint at;
  foot.u = std::clamp(u, lo, hi);
  curve.evaluate1(foot.u, at);
  for (int i = 0; i < steps; ++i) {
    foot.u = std::clamp(foot.u + directStep(at, p), lo, hi);
    curve.evaluate1(foot.u, at);
  }
  foot.evaluations = steps + 1;
  foot.point = at.C;
  foot.distance = (at.C - p).norm();
  foot.converged = true;
  return foot;
}

CurveFoot newtonFoot(const spline::Curve& curve, const Vector3d& p, double u, double tolerance,
                     int max_evaluations) noexcept {
  constexpr double kMinCurvature = 0.05;  // 1 + depth * curvature below it: first-order step instead
  const auto [lo, hi] = curve.domain();
  CurveFoot foot;
  foot.distance = std::numeric_limits<double>::infinity();
  double next = std::clamp(u, lo, hi);
  spline::CurvePoint at;
  while (foot.evaluations < max_evaluations) {
    curve.evaluate2(next, at);
    ++foot.evaluations;
    const double distance = (at.C - p).norm();
    if (!(distance <= foot.distance)) {
      if (std::abs(next - foot.u) * at.C1.norm() <= tolerance) {
        foot.converged = true;
        return foot;
      }
      next = 0.5 * (next + foot.u);
      continue;
    }
    foot.u = next;
    foot.point = at.C;
    foot.distance = distance;
    const double first = at.C1.squaredNorm(), second = first + (at.C - p).dot(at.C2);
    if (!(first > 0)) return foot;
    const double step = -(at.C - p).dot(at.C1) / (second > kMinCurvature * first ? second : first);
    next = std::clamp(foot.u + step, lo, hi);
    foot.converged = std::abs(next - foot.u) * std::sqrt(first) <= tolerance;
    if (foot.converged) return foot;
  }
  return foot;
}

}  // namespace hapticd::trace
