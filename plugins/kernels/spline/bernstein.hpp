// SPDX-License-Identifier: MIT
/// Rational curves by their Bernstein coefficients over 0 to 1, and how they change if the parameter is replaced by a
/// quadratic function of another one.
#pragma once
#include <Eigen/Core>
#include <vector>

namespace hapticd::spline {

/// A control point [m] with its weight.
struct Weighted {
  Eigen::Vector3d point{0, 0, 0};
  double weight = 0;

  /// Adds a share of another one. The mean of equal points is exactly that point.
  void add(const Weighted& other, double share);
};
using BezierCurve = std::vector<Weighted>;

/// [main] Returns the curve as a function of y, with twice the degree. Its parameter is x(y), whose Bernstein
/// coefficients are 0, `bend` (0 to 1) and 1. Source: DeRose, Composing Bezier simplexes, ACM TOG 1988.
BezierCurve composed(const BezierCurve& curve, double bend);

/// [main] Returns a polynomial curve of the given degree that passes through the same points as composed() at the
/// Chebyshev-Lobatto nodes. @param error [m] becomes the largest distance between the two, if that is larger
BezierCurve fitted(const BezierCurve& curve, double bend, int degree, double& error);

/// [main] Returns the same curve with a degree that is higher by 1. Its weights are multiplied by a factor that changes
/// evenly from `from` to `to`.
BezierCurve multiplied(const BezierCurve& curve, double from, double to);

/// [main] Makes the beginning of a curve straight, up to coefficient `end`. It takes the direction in which the curve
/// goes on, so that the curve has no kink there.
void straightenBeginning(BezierCurve& curve, std::size_t end);

}  // namespace hapticd::spline
