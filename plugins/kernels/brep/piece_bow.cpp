// SPDX-License-Identifier: MIT
#include "kernels/brep/piece_bow.hpp"

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

PieceBow bowOf(const Geometry& geometry, std::uint32_t curve, double t0, double t1) {
  constexpr int kSamples = 9;
  constexpr double kStraight = 1e-6;  // length times curvature; below it, the centre would be mostly rounding error
  std::array<Bend, kSamples> bends;
  const double end = t1 - 1e-9 * (t1 - t0);  // at a knot, derivatives are evaluated in the span to its right
  for (int i = 0; i < kSamples; ++i)
    bends[static_cast<std::size_t>(i)] = bendAt(geometry, curve, std::min(t0 + (t1 - t0) * i / (kSamples - 1), end));
  const Bend& middle = bends[kSamples / 2];
  const double length = (bends.back().C - bends.front().C).norm(), bend = middle.K.norm();
  PieceBow bow;
  bow.bow = middle.K;
  bow.along = middle.T;
  const bool straight = !(bend * length > kStraight);
  bow.centre = straight ? middle.C : Vector3d(middle.C + middle.K / (bend * bend));
  bow.across = straight ? middle.T.unitOrthogonal() : middle.T.cross(middle.K).normalized();
  double low = 1, high = -1;
  for (const Bend& b : bends) {
    const Vector3d dk = b.K - middle.K, dt = b.T - middle.T, from = b.C - bow.centre;
    bow.bow_off = std::max(bow.bow_off, kBetweenSamples * dk.norm());
    bow.bow_off_across = std::max(bow.bow_off_across, kBetweenSamples * std::abs(dk.dot(bow.across)));
    bow.along_off = std::max(bow.along_off, kBetweenSamples * dt.norm());
    bow.along_off_across = std::max(bow.along_off_across, kBetweenSamples * std::abs(dt.dot(bow.across)));
    bow.slide = std::max(bow.slide, kBetweenSamples * std::abs(from.dot(b.T)));
    const double turn = 1 + from.dot(b.K);
    low = &b == &bends.front() ? turn : std::min(low, turn);
    high = &b == &bends.front() ? turn : std::max(high, turn);
  }
  bow.turn_low = low - (kBetweenSamples - 1) * (high - low) - kTermRounding;
  bow.turn_high = high + (kBetweenSamples - 1) * (high - low) + kTermRounding;
  return bow;
}

double leastBendSeenFrom(const PieceBow& bow, const Vector3d& p) noexcept {
  const Vector3d from = bow.centre - p;
  const double aside = from.dot(bow.across), flat = (from - aside * bow.across).norm();
  return bow.turn_low + from.dot(bow.bow) - flat * bow.bow_off - std::abs(aside) * bow.bow_off_across;
}

FeetOfPiece feetSeenFrom(const PieceBow& bow, const Vector3d& p) noexcept {
  const Vector3d from = bow.centre - p;
  const double aside = from.dot(bow.across), flat = (from - aside * bow.across).norm();
  const double curve = from.dot(bow.bow), off = flat * bow.bow_off + std::abs(aside) * bow.bow_off_across;
  if (bow.turn_low + curve - off > 0) return FeetOfPiece::kOne;
  const double slope = flat * bow.along_off + std::abs(aside) * bow.along_off_across + bow.slide;
  if (std::abs(from.dot(bow.along)) * (1 - kTermRounding) > slope) return FeetOfPiece::kOne;
  return bow.turn_high + curve + off < 0 ? FeetOfPiece::kAtAnEnd : FeetOfPiece::kUnknown;
}

}  // namespace hapticd::brep
