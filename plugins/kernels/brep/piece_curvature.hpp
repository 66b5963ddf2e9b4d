// SPDX-License-Identifier: MIT
/// Bounds of how a piece of a curve bends. They show how many feet a probe has on the piece without computing the feet,
/// even if the probe is beyond a centre of curvature.
#pragma once
#include <Eigen/Core>

#include "kernels/brep/geometry.hpp"

namespace hapticd::brep {

/// Safety factor: a quantity that is sampled on a curve or surface is assumed to be larger between the samples by at
/// most this factor.
inline constexpr double kBetweenSamples = 1.5;

/// Curvature vectors K and unit tangents T of a piece. C is a point of the piece. Along the arc, half of the squared
/// distance to a probe p has the derivatives (C - p) T and 1 + (C - p) K. Each is split at the centre of curvature o:
/// (C - o) T and (C - o) K hardly change along the piece, and (o - p) T and (o - p) K follow from T and K in the
/// middle.
struct PieceCurvature {
  Eigen::Vector3d centre{0, 0, 0};     ///< o [m]
  Eigen::Vector3d curvature{0, 0, 0};  ///< K in the middle [1/m]
  Eigen::Vector3d tangent{1, 0, 0};    ///< T in the middle, unit
  Eigen::Vector3d binormal{0, 0, 1};   ///< T x K in the middle, unit; the components of K and T along it hardly change
  /// [1/m] largest difference of K from K in the middle: of the vector, and along `binormal`.
  double curvature_off = 0, curvature_off_across = 0;
  double tangent_off = 0, tangent_off_across = 0;  ///< the same for T
  double second_low = 0, second_high = 0;          ///< range of 1 + (C - o) K over the piece
  double slope = 0;                                ///< [m] largest absolute value of (C - o) T
};

/// [main] Measures the piece of a curve from t0 to t1. The piece must turn by less than a right angle.
PieceCurvature pieceCurvature(const Geometry& geometry, std::uint32_t curve, double t0, double t1);

enum class FeetOfPiece : std::uint8_t {
  kOne,      ///< the distance has one minimum, or grows from one end to the other
  kAtAnEnd,  ///< the only minima are the ends
  kUnknown
};

/// [rt] Returns a lower bound, over the piece, of the second derivative of half the squared distance to p along the
/// arc. If it is above 0, p has one foot on the piece; otherwise the number of feet is not known from it.
double leastSecondDerivative(const PieceCurvature& piece, const Eigen::Vector3d& p) noexcept;

/// [any] Returns how many feet p has on the piece.
FeetOfPiece countFeet(const PieceCurvature& piece, const Eigen::Vector3d& p) noexcept;

}  // namespace hapticd::brep
