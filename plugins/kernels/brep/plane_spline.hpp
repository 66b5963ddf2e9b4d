// SPDX-License-Identifier: MIT
/// A spline in a parameter plane, evaluated from where it stands in its part. There are more of these than of all other
/// splines, and few are ever asked in a tick: so they keep no copy, and pay for it by the divisions of their knots.
#pragma once
#include <vector>

#include "kernels/brep/part.hpp"
#include "kernels/spline/kernel.hpp"

namespace hapticd::brep {

/// Point and first derivative.
struct PlaneSplinePoint {
  double c[2], c1[2];
};

class PlaneSpline {
 public:
  /// [main] Of a record of kind kSpline. @throws std::invalid_argument as spline::validate() does.
  PlaneSpline(const Part& part, const Curve2& curve);

  /// [any] The same to the last bit as a spline::Curve gives. `reals` and `curve` are those of the constructor.
  PlaneSplinePoint at(const std::vector<double>& reals, const Curve2& curve, double t) const noexcept;

 private:
  spline::NetKernel kernel_ = nullptr;
  double scale_ = 1;         ///< coordinates = scale_ * what the kernel sees
  double weight_scale_ = 0;  ///< the kernel sees weight_scale_ * those of the part; 0: the curve is polynomial
};

/// [main] The distinct knots of a record of kind kSpline in its domain, ascending.
std::vector<double> breaksOf(const Part& part, const Curve2& curve);

}  // namespace hapticd::brep
