// SPDX-License-Identifier: MIT
/// Closest points on curves: the paper's first-order step, and Newton.
#pragma once
#include "kernels/spline/curve.hpp"

namespace hapticd::trace {

/// A foot on a curve.
struct CurveFoot {
  double u = 0;
  Eigen::Vector3d point{0, 0, 0};
  double distance = 0;  ///< [m]
  int evaluations = 0;
  bool converged = false;
};

/// [rt] Parameter step of direct parametric tracing: <psi, C'> / |C'|^2 with psi from the curve point to the probe
/// (Thompson et al. 1999, Eq. 3, with the exact derivative: Eq. 2 as printed holds for polynomial curves alone).
double directStep(const spline::CurvePoint& at, const Eigen::Vector3d& p) noexcept;

/// [rt] `steps` such steps from u, each clamped to the domain.
CurveFoot directFoot(const spline::Curve& curve, const Eigen::Vector3d& p, double u, int steps) noexcept;

/// [rt] Nearest point near u: safeguarded Newton; the distance never increases. Stops when the step is shorter than
/// `tolerance` [m] or after `max_evaluations`.
CurveFoot newtonFoot(const spline::Curve& curve, const Eigen::Vector3d& p, double u, double tolerance,
                     int max_evaluations) noexcept;

}  // namespace hapticd::trace
