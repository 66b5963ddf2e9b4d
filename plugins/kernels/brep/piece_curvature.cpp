// SPDX-License-Identifier: MIT
#include "kernels/brep/piece_curvature.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

constexpr double kTermRounding = 1e-9;  ///< relative to the terms that are compared

struct Bend {
  Vector3d C, T, K;
};

Bend bendAt(const Geometry& geometry, std::uint32_t curve, double t) {
  spline::CurvePoint C;
  geometry.curve(curve, t, C);
  const double speed2 = C.C1.squaredNorm();
  if (!(speed2 > 0)) return {C.C, Vector3d::Zero(), Vector3d::Zero()};
  const Vector3d T = C.C1 / std::sqrt(speed2);
  return {C.C, T, (C.C2 - C.C2.dot(T) * T) / speed2};
}

}  // namespace

PieceCurvature pieceCurvature(const Geometry& geometry, std::uint32_t curve, double t0, double t1) {
  constexpr int kSamples = 9;
  constexpr double kStraight = 1e-6;  // length times curvature; below it, the centre would be mostly rounding error
  std::array<Bend, kSamples> bends;
  const double end = t1 - 1e-9 * (t1 - t0);  // at a knot, derivatives are evaluated in the span to its right
  for (int i = 0; i < kSamples; ++i)
    bends[static_cast<std::size_t>(i)] = bendAt(geometry, curve, std::min(t0 + (t1 - t0) * i / (kSamples - 1), end));
  const Bend& middle = bends[kSamples / 2];
  const double length = (bends.back().C - bends.front().C).norm(), most = middle.K.norm();
  PieceCurvature piece;
  piece.curvature = middle.K;
  piece.tangent = middle.T;
  const bool straight = !(most * length > kStraight);
  piece.centre = straight ? middle.C : Vector3d(middle.C + middle.K / (most * most));
  piece.binormal = straight ? middle.T.unitOrthogonal() : middle.T.cross(middle.K).normalized();
  double low = 1, high = -1;
  for (const Bend& b : bends) {
    const Vector3d dk = b.K - middle.K, dt = b.T - middle.T, from = b.C - piece.centre;
    piece.curvature_off = std::max(piece.curvature_off, kBetweenSamples * dk.norm());
    piece.curvature_off_across =
        std::max(piece.curvature_off_across, kBetweenSamples * std::abs(dk.dot(piece.binormal)));
    piece.tangent_off = std::max(piece.tangent_off, kBetweenSamples * dt.norm());
    piece.tangent_off_across = std::max(piece.tangent_off_across, kBetweenSamples * std::abs(dt.dot(piece.binormal)));
    piece.slope = std::max(piece.slope, kBetweenSamples * std::abs(from.dot(b.T)));
    const double second = 1 + from.dot(b.K);
    low = &b == &bends.front() ? second : std::min(low, second);
    high = &b == &bends.front() ? second : std::max(high, second);
  }
  piece.second_low = low - (kBetweenSamples - 1) * (high - low) - kTermRounding;
  piece.second_high = high + (kBetweenSamples - 1) * (high - low) + kTermRounding;
  return piece;
}

double leastSecondDerivative(const PieceCurvature& piece, const Vector3d& p) noexcept {
  const Vector3d from = piece.centre - p;
  const double aside = from.dot(piece.binormal), flat = (from - aside * piece.binormal).norm();
  return piece.second_low + from.dot(piece.curvature) - flat * piece.curvature_off -
         std::abs(aside) * piece.curvature_off_across;
}

FeetOfPiece countFeet(const PieceCurvature& piece, const Vector3d& p) noexcept {
  const Vector3d from = piece.centre - p;
  const double aside = from.dot(piece.binormal), flat = (from - aside * piece.binormal).norm();
  const double curve = from.dot(piece.curvature),
               off = flat * piece.curvature_off + std::abs(aside) * piece.curvature_off_across;
  if (piece.second_low + curve - off > 0) return FeetOfPiece::kOne;
  const double slope = flat * piece.tangent_off + std::abs(aside) * piece.tangent_off_across + piece.slope;
  if (std::abs(from.dot(piece.tangent)) * (1 - kTermRounding) > slope) return FeetOfPiece::kOne;
  return piece.second_high + curve + off < 0 ? FeetOfPiece::kAtAnEnd : FeetOfPiece::kUnknown;
}

}  // namespace hapticd::brep
