// SPDX-License-Identifier: MIT
/// A spline surface as plain data, as in a model file, and the rules that it must keep.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace hapticd::spline {

/// Highest degree of a curve, and of a surface along u and along v.
inline constexpr int kMaxDegree = 15;
/// Narrowest knot span and largest absolute value of a knot. Within these limits, first and second derivatives do not
/// overflow.
inline constexpr double kNarrowestSpan = 1e-100;
inline constexpr double kWidestKnot = 1e100;
/// Largest ratio of two weights of one surface. Beyond it the point with the smaller weight would not affect the
/// surface at all.
inline constexpr double kMaxWeightRatio = 1e100;

/// A tensor-product spline surface, rational if it has weights. In pairs, index 0 is u and index 1 is v.
struct SurfaceData {
  std::array<int, 2> degree{1, 1};
  std::array<std::vector<double>, 2> knots;  ///< count + degree + 1 values each, non-decreasing
  std::vector<Eigen::Vector3d> points;       ///< [m] u-major: index = i * count(1) + j
  std::vector<double> weights;               ///< one per point; empty for a polynomial surface
  bool reversed = false;                     ///< true if the outward normal is -(Su x Sv)
  std::string name;                          ///< name for messages

  /// [any] Returns the number of control points along an axis, which follows from the number of knots.
  int count(int axis) const noexcept {
    const auto a = static_cast<std::size_t>(axis);
    return static_cast<int>(knots[a].size()) - degree[a] - 1;
  }
  /// [any] Returns the parameter range [lo, hi] along an axis. The data must have passed validate().
  std::array<double, 2> domain(int axis) const noexcept {
    const auto a = static_cast<std::size_t>(axis);
    return {knots[a][static_cast<std::size_t>(degree[a])], knots[a][static_cast<std::size_t>(count(axis))]};
  }
};

/// Receives what is wrong. @param where beginning of the message, such as "surface 'lid': knots[u][3]"
using Tell = std::function<void(const std::string& where, const std::string& why)>;

/// [main] Checks degrees, knots, counts, coordinates and weights.
/// @throws std::invalid_argument with a message for the user that names the surface, the knot or point, and what was
/// expected.
void validate(const SurfaceData& data);

/// [main] Checks one knot vector for `count` control points. @param what beginning of the message, such as "surface
/// 'lid': knots[u]"
/// @throws std::invalid_argument
void validateKnots(const std::vector<double>& knots, int degree, std::size_t count, const std::string& what);

/// [main] Checks that the points are finite. If there are weights, checks that there is one per point and that each is
/// positive and finite.
/// @throws std::invalid_argument
void validatePoints(const std::vector<Eigen::Vector3d>& points, const std::vector<double>& weights,
                    const std::string& what);

/// [main] True if all control points lie in one place or on one line. Such a surface has no normal.
bool hasNoArea(const SurfaceData& surface);

/// The parts of a surface, each of which can be checked although another one could not be read.
struct SoundParts {
  bool degree = true, points = true, weights = true;
  std::array<bool, 2> knots{true, true};
};

/// [main] Makes the same checks of the parts that could be read, and reports everything that is wrong.
void checkParts(const SurfaceData& data, const SoundParts& read, const Tell& tell);

}  // namespace hapticd::spline
