// SPDX-License-Identifier: MIT
/// A spline curve in a parameter plane, evaluated directly from the numbers in its part. A part has more such curves
/// than other splines, and few are evaluated in a tick. So they keep no copy of their data, and divide by knot spans at
/// each evaluation.
#pragma once
#include <vector>

#include "kernels/part/part.hpp"
#include "kernels/spline/kernel.hpp"

namespace hapticd::brep {

/// Point and first derivative.
struct PlaneSplinePoint {
  double c[2], c1[2];
};

class PlaneSpline {
 public:
  /// [main] Takes a curve of kind kSpline. @throws std::invalid_argument as spline::validate() does.
  PlaneSpline(const Part& part, const Curve2& curve);

  /// [any] Gives bit for bit the same result as spline::Curve. `reals` and `curve` must be those of the constructor's
  /// part.
  PlaneSplinePoint at(const std::vector<double>& reals, const Curve2& curve, double t) const noexcept;

 private:
  spline::NetKernel kernel_ = nullptr;
  double scale_ = 1;  ///< coordinates = scale_ * coordinates in the kernel
  /// Weights in the kernel = weight_scale_ * weights of the part; 0 if the curve is polynomial.
  double weight_scale_ = 0;
};

/// [main] Returns the distinct knots of a curve of kind kSpline inside its domain, ascending.
std::vector<double> breaksOf(const Part& part, const Curve2& curve);

}  // namespace hapticd::brep
