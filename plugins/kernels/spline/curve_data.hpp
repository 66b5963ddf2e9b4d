// SPDX-License-Identifier: MIT
/// A spline curve as plain data: degree, knots, points and weights.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace hapticd::spline {

/// A spline curve in space, rational if it has weights.
struct CurveData {
  int degree = 1;
  std::vector<double> knots;            ///< number of points + degree + 1 values, non-decreasing
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<double> weights;          ///< one per point; empty for a polynomial curve
  std::string name;                     ///< name for messages

  /// [any] Returns the parameter range [lo, hi]. The data must have passed validate().
  std::array<double, 2> domain() const noexcept {
    return {knots[static_cast<std::size_t>(degree)], knots[points.size()]};
  }
};

/// [main] Checks a curve by the same rules as validate(SurfaceData).
/// @throws std::invalid_argument with a message for the user.
void validate(const CurveData& data);

}  // namespace hapticd::spline
