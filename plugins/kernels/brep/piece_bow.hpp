// SPDX-License-Identifier: MIT
/// Bounds of how a piece of a curve bends. They show how many feet a probe has on the piece without computing the feet,
/// even if the probe is beyond a centre of curvature.
#pragma once
#include <Eigen/Core>

#include "kernels/brep/geometry.hpp"

namespace hapticd::brep {

/// Factor by which a quantity between samples of a curve or surface may be larger than at the samples.
inline constexpr double kBetweenSamples = 1.5;

/// Curvature vectors K and unit tangents T of a piece. C is a point of the piece. Along the arc, half of the squared
/// distance to a probe p has the derivatives (C - p) T and 1 + (C - p) K. Each is split at the centre of curvature o:
/// (C - o) T and (C - o) K hardly change along the piece, and (o - p) T and (o - p) K follow from T and K in the
/// middle.
struct PieceBow {
  Eigen::Vector3d centre{0, 0, 0};  ///< o [m]
  Eigen::Vector3d bow{0, 0, 0};     ///< K in the middle [1/m]
  Eigen::Vector3d along{1, 0, 0};   ///< T in the middle, unit
  Eigen::Vector3d across{0, 0, 1};  ///< T x K in the middle, unit; the components of K and T along it hardly change
  /// [1/m] largest difference of K from K in the middle: of the vector, and along `across`.
  double bow_off = 0, bow_off_across = 0;
  double along_off = 0, along_off_across = 0;  ///< the same for T
  double turn_low = 0, turn_high = 0;          ///< range of 1 + (C - o) K over the piece
  double slide = 0;                            ///< [m] largest absolute value of (C - o) T
};

/// [main] Measures the piece of a curve from t0 to t1. The piece must turn by less than a right angle.
PieceBow bowOf(const Geometry& geometry, std::uint32_t curve, double t0, double t1);

enum class FeetOfPiece : std::uint8_t {
  kOne,      ///< the distance has one minimum, or grows from one end to the other
  kAtAnEnd,  ///< the only minima are the ends
  kUnknown
};

/// [rt] Returns a lower bound, over the piece, of the second derivative of half the squared distance to p along the
/// arc. If it is not above 0, nothing follows from it.
double leastBendSeenFrom(const PieceBow& bow, const Eigen::Vector3d& p) noexcept;

/// [any] Returns how many feet p has on the piece.
FeetOfPiece feetSeenFrom(const PieceBow& bow, const Eigen::Vector3d& p) noexcept;

}  // namespace hapticd::brep
