// SPDX-License-Identifier: MIT
/// A spline surface as a model file states it, and the rules it must keep.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace hapticd::spline {

/// Highest degree of a curve, and of a surface in either direction.
inline constexpr int kMaxDegree = 15;
/// Narrowest knot span, widest knot: one over their products stays a finite double through two derivatives.
inline constexpr double kNarrowestSpan = 1e-100;
inline constexpr double kWidestKnot = 1e100;
/// Largest ratio of two weights of one surface: beyond it the lighter point moves the surface by nothing.
inline constexpr double kMaxWeightRatio = 1e100;

/// A tensor-product spline surface, rational if it has weights. Index 0 of pairs is u, 1 is v.
struct SurfaceData {
  std::array<int, 2> degree{1, 1};
  std::array<std::vector<double>, 2> knots;  ///< count + degree + 1 each, non-decreasing
  std::vector<Eigen::Vector3d> points;       ///< [m] u-major: index = i * count(1) + j
  std::vector<double> weights;               ///< one per point; empty: polynomial
  bool reversed = false;                     ///< outward normal = -(Su x Sv)
  std::string name;                          ///< for messages

  /// [any] Number of control points along an axis, as the knots state it.
  int count(int axis) const noexcept {
    const auto a = static_cast<std::size_t>(axis);
    return static_cast<int>(knots[a].size()) - degree[a] - 1;
  }
  /// [any] The parameter range [lo, hi] along an axis. Only for valid data.
  std::array<double, 2> domain(int axis) const noexcept {
    const auto a = static_cast<std::size_t>(axis);
    return {knots[a][static_cast<std::size_t>(degree[a])], knots[a][static_cast<std::size_t>(count(axis))]};
  }
};

/// [main] Checks degrees, knots, counts, coordinates and weights.
/// @throws std::invalid_argument with a message for the user: which surface, which knot or point, what was expected.
void validate(const SurfaceData& data);

/// [main] Checks one knot vector for `count` control points; `what` opens the message, as "surface 'lid': knots[u]".
/// @throws std::invalid_argument
void validateKnots(const std::vector<double>& knots, int degree, std::size_t count, const std::string& what);

/// [main] Checks that points are finite and that weights, where there are any, are positive, finite, one per point.
/// @throws std::invalid_argument
void validatePoints(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights,
                    const std::string& what);

}  // namespace hapticd::spline
