// SPDX-License-Identifier: MIT
/// Bounds of how a piece of a curve bends. They show how many feet a probe has on the piece without computing the feet,
/// even if the probe is beyond a centre of curvature.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "kernels/brep/geometry/geometry.hpp"
#include "kernels/brep/tree/coarse.hpp"

namespace hapticd::brep {

/// Safety factor: a quantity that is sampled on a curve or surface is assumed to be larger between the samples by at
/// most this factor.
inline constexpr double kBetweenSamples = 1.5;

/// Curvature vectors K and unit tangents T of a piece. C is a point of the piece. Along the arc, half of the squared
/// distance to a probe p has the derivatives (C - p) T and 1 + (C - p) K. Each is split at the centre of curvature o:
/// (C - o) T and (C - o) K hardly change along the piece, and (o - p) T and (o - p) K follow from T and K in the
/// middle.
///
/// A part has many pieces, so the numbers are rounded as far as the bounds allow. The vectors are rounded first, and
/// the bounds are measured with the rounded ones: then they are exact for these.
struct PieceCurvature {
  /// o [m]. In double precision, because it is far away from a nearly straight piece: rounding would move it by a part
  /// of the piece's length.
  Eigen::Vector3d centre{0, 0, 0};
  Eigen::Vector3f curvature{0, 0, 0};     ///< about K in the middle [1/m]
  Eigen::Vector3f tangent{1, 0, 0};       ///< about T in the middle
  Eigen::Vector3f binormal{0, 0, 1};      ///< about T x K, unit; the components of K and T along it hardly change
  float second_low = 0, second_high = 0;  ///< range of 1 + (C - o) K over the piece
  /// [1/m] largest difference of K from `curvature`: of the vector, and along `binormal`.
  Coarse curvature_off, curvature_off_across;
  Coarse tangent_off, tangent_off_across;  ///< the same for T
  Coarse slope;                            ///< [m] largest absolute value of (C - o) T
  Coarse most;                             ///< [1/m] largest curvature; not set by pieceCurvature()
};

/// The same vectors before rounding.
struct PieceFrame {
  Eigen::Vector3d centre{0, 0, 0}, curvature{0, 0, 0}, tangent{1, 0, 0}, binormal{0, 0, 1};
};

/// [main] True if tangent and curvature of a curve hardly change at a knot, so that a piece or leaf may go on beyond
/// it.
/// @param narrow how far before the knot the curve is evaluated
bool isSmoothAt(const Geometry& geometry, std::uint32_t curve, double knot, double narrow);

/// [main] Returns parameters from t0 to t1, in order, at which a piece of a curve is measured: at least nine, five of
/// each span. The last one of a span is just before its end, because derivatives at a knot are those of the span to the
/// right.
std::vector<double> pieceSamples(const Geometry& geometry, std::uint32_t curve, double t0, double t1);

/// [main] Returns the frame in the middle of the piece of a curve from t0 to t1.
PieceFrame pieceFrame(const Geometry& geometry, std::uint32_t curve, double t0, double t1);

/// [main] Measures the piece of a curve from t0 to t1. The piece must turn by less than a right angle. @param frame
/// result of pieceFrame()
PieceCurvature pieceCurvature(const Geometry& geometry, std::uint32_t curve, double t0, double t1,
                              const PieceFrame& frame);

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
