// SPDX-License-Identifier: MIT
#include "kernels/brep/elements/piece_curvature.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

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

std::vector<Bend> bendsOf(const Geometry& geometry, std::uint32_t curve, double t0, double t1) {
  std::vector<Bend> bends;
  for (const double t : pieceSamples(geometry, curve, t0, t1)) bends.push_back(bendAt(geometry, curve, t));
  return bends;
}

double valueOf(Coarse bound) noexcept {
  return static_cast<double>(bound.value());
}

/// A vector from the probe to the centre of curvature: its component along the binormal, and the length of the rest.
struct FromProbe {
  FromProbe(const PieceCurvature& piece, const Vector3d& p) noexcept
      : from(piece.centre - p), aside(from.dot(piece.binormal.cast<double>())) {
    flat = (from - aside * piece.binormal.cast<double>()).norm();
    aside = std::abs(aside);
  }
  double curveOff(const PieceCurvature& piece) const noexcept {
    return flat * valueOf(piece.curvature_off) + aside * valueOf(piece.curvature_off_across);
  }

  Vector3d from;
  double aside, flat;
};

}  // namespace

bool isSmoothAt(const Geometry& geometry, std::uint32_t curve, double knot, double narrow) {
  constexpr double kSame = 1e-6, kSameCurvature = 0.1;
  spline::CurvePoint C;
  std::array<Vector3d, 2> first, bend;
  for (const std::size_t side : {0, 1}) {
    geometry.curve(curve, side == 0 ? knot - narrow : knot, C);
    const double speed2 = C.C1.squaredNorm();
    if (!(speed2 > 0)) return false;
    first[side] = C.C1;
    bend[side] = (C.C2 - C.C2.dot(C.C1) / speed2 * C.C1) / speed2;
  }
  return (first[0] - first[1]).norm() <= kSame * first[1].norm() &&
         (bend[0] - bend[1]).norm() <= kSameCurvature * std::max(bend[0].norm(), bend[1].norm());
}

std::vector<double> pieceSamples(const Geometry& geometry, std::uint32_t curve, double t0, double t1) {
  constexpr int kFewest = 8, kPerSpan = 4;
  std::vector<double> stops{t0};
  for (const double knot : geometry.curveKnots(curve))
    if (knot > t0 && knot < t1) stops.push_back(knot);
  stops.push_back(t1);
  const int spans = static_cast<int>(stops.size()) - 1, each = std::max(kPerSpan, (kFewest + spans - 1) / spans);
  std::vector<double> samples;
  for (std::size_t s = 0; s + 1 < stops.size(); ++s)
    for (int i = 0; i <= each; ++i)
      samples.push_back(stops[s] + (stops[s + 1] - stops[s]) * (i < each ? static_cast<double>(i) / each : 1 - 1e-9));
  return samples;
}

PieceFrame pieceFrame(const Geometry& geometry, std::uint32_t curve, double t0, double t1) {
  constexpr double kStraight = 1e-6;  // length times curvature; below it, the centre would be mostly rounding error
  const Bend middle = bendAt(geometry, curve, 0.5 * (t0 + t1));
  const double length = (bendAt(geometry, curve, t1).C - bendAt(geometry, curve, t0).C).norm(), most = middle.K.norm();
  const bool straight = !(most * length > kStraight);
  PieceFrame frame;
  frame.curvature = middle.K;
  frame.tangent = middle.T;
  frame.centre = straight ? middle.C : Vector3d(middle.C + middle.K / (most * most));
  frame.binormal = straight ? middle.T.unitOrthogonal() : middle.T.cross(middle.K).normalized();
  return frame;
}

PieceCurvature pieceCurvature(const Geometry& geometry, std::uint32_t curve, double t0, double t1,
                              const PieceFrame& frame) {
  PieceCurvature piece;
  piece.centre = frame.centre;
  piece.curvature = frame.curvature.cast<float>();
  piece.tangent = frame.tangent.cast<float>();
  piece.binormal = frame.binormal.cast<float>();
  const Vector3d across = piece.binormal.cast<double>();
  double low = 2, high = -2, slope = 0, most[4]{};
  bool first = true;
  for (const Bend& b : bendsOf(geometry, curve, t0, t1)) {
    const Vector3d dk = b.K - piece.curvature.cast<double>(), dt = b.T - piece.tangent.cast<double>(),
                   from = b.C - piece.centre;
    const double off[4] = {dk.norm(), std::abs(dk.dot(across)), dt.norm(), std::abs(dt.dot(across))};
    for (int i = 0; i < 4; ++i) most[i] = std::max(most[i], kBetweenSamples * off[i]);
    slope = std::max(slope, kBetweenSamples * std::abs(from.dot(b.T)));
    const double second = 1 + from.dot(b.K);
    low = first ? second : std::min(low, second);
    high = first ? second : std::max(high, second);
    first = false;
  }
  piece.curvature_off = Coarse::up(most[0]);
  piece.curvature_off_across = Coarse::up(most[1]);
  piece.tangent_off = Coarse::up(most[2]);
  piece.tangent_off_across = Coarse::up(most[3]);
  piece.slope = Coarse::up(slope);
  const double more = (kBetweenSamples - 1) * (high - low) + kTermRounding;
  constexpr float kUp = std::numeric_limits<float>::infinity();
  piece.second_low = std::nextafter(static_cast<float>(low - more), -kUp);
  piece.second_high = std::nextafter(static_cast<float>(high + more), kUp);
  return piece;
}

double leastSecondDerivative(const PieceCurvature& piece, const Vector3d& p) noexcept {
  const FromProbe probe(piece, p);
  return static_cast<double>(piece.second_low) + probe.from.dot(piece.curvature.cast<double>()) - probe.curveOff(piece);
}

FeetOfPiece countFeet(const PieceCurvature& piece, const Vector3d& p) noexcept {
  const FromProbe probe(piece, p);
  const double curve = probe.from.dot(piece.curvature.cast<double>()), off = probe.curveOff(piece);
  if (static_cast<double>(piece.second_low) + curve - off > 0) return FeetOfPiece::kOne;
  const double slope =
      probe.flat * valueOf(piece.tangent_off) + probe.aside * valueOf(piece.tangent_off_across) + valueOf(piece.slope);
  if (std::abs(probe.from.dot(piece.tangent.cast<double>())) * (1 - kTermRounding) > slope) return FeetOfPiece::kOne;
  return static_cast<double>(piece.second_high) + curve + off < 0 ? FeetOfPiece::kAtAnEnd : FeetOfPiece::kUnknown;
}

}  // namespace hapticd::brep
