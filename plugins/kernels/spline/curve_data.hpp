// SPDX-License-Identifier: MIT
/// A spline curve as data.
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace hapticd::spline {

/// A spline curve in space, rational if it has weights.
struct CurveData {
  int degree = 1;
  std::vector<double> knots;            ///< points + degree + 1, non-decreasing
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<double> weights;          ///< one per point; empty: polynomial
  std::string name;                     ///< for messages

  /// [any] The parameter range [lo, hi]. Only for valid data.
  std::array<double, 2> domain() const noexcept {
    return {knots[static_cast<std::size_t>(degree)], knots[points.size()]};
  }
};

/// [main] Checks a curve as validate(SurfaceData) checks a surface.
/// @throws std::invalid_argument with a message for the user.
void validate(const CurveData& data);

}  // namespace hapticd::spline
