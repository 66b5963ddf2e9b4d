// SPDX-License-Identifier: MIT
/// How a piece of a curve bends, so that its distance function can be judged from anywhere, also from beyond its centre
/// of curvature.
#pragma once
#include <Eigen/Core>

#include "kernels/brep/geometry.hpp"

namespace hapticd::brep {

/// What is measured at samples of a curve or surface may be larger by this factor between them.
inline constexpr double kBetweenSamples = 1.5;

/// Curvature vectors K and tangents T of a piece. Along the arc, the half of the squared distance to p has the
/// derivatives (C - p) T and 1 + (C - p) K. About the centre of curvature o, (C - o) T and (C - o) K hardly change, and
/// (o - p) K and (o - p) T are known from those in the middle of the piece.
struct PieceBow {
  Eigen::Vector3d centre{0, 0, 0};             ///< o [m]
  Eigen::Vector3d bow{0, 0, 0};                ///< K in the middle [1/m]
  Eigen::Vector3d along{1, 0, 0};              ///< T x K, unit; K and T hardly have a part along it
  Eigen::Vector3d across{0, 0, 1};             ///< T x K, unit: K and T hardly change along it
  double bow_off = 0, bow_off_across = 0;      ///< [1/m] largest difference of K from that in the middle
  double along_off = 0, along_off_across = 0;  ///< the same of T
  double turn_low = 0, turn_high = 0;          ///< range of 1 + (C - o) K
  double slide = 0;                            ///< [m] largest (C - o) T
};

/// [main] Of the piece of a curve from t0 to t1, which bends by less than a right angle.
PieceBow bowOf(const Geometry& geometry, std::uint32_t curve, double t0, double t1);

enum class FeetOfPiece : std::uint8_t {
  kOne,      ///< the distance has one minimum, or grows from one end to the other
  kAtAnEnd,  ///< the only minima are the ends
  kUnknown
};

/// [rt] The least second derivative along the arc that half of the squared distance to p has on the piece; if it is not
/// above 0, nothing is known.
double leastBendSeenFrom(const PieceBow& bow, const Eigen::Vector3d& p) noexcept;

/// [any] How p sees the piece.
FeetOfPiece feetSeenFrom(const PieceBow& bow, const Eigen::Vector3d& p) noexcept;

}  // namespace hapticd::brep
