// SPDX-License-Identifier: MIT
#include "simulated/nearest_place.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace hapticd::simulated {
namespace {

using Eigen::Vector3d;
using kinematics::JointVector;

/// Returns the place in whole mm, moved towards the middle of the workspace until the arm reaches it: rounding may have
/// moved it beyond a stop.
std::optional<Vector3d> inWholeMillimetres(const kinematics::Arm& arm, const Vector3d& place, JointVector q) {
  constexpr int kMost = 20;  // mm
  kinematics::Pose middle;
  if (!arm.forward(arm.neutral(), middle)) return std::nullopt;
  const Vector3d inwards = (middle.position - place).normalized();
  for (int mm = 0; mm < kMost; ++mm) {
    const Vector3d rounded = ((place + 1e-3 * mm * inwards) * 1e3).array().round() * 1e-3;
    if (arm.inverse(rounded, q)) return rounded;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vector3d> nearestPlace(const kinematics::Arm& arm, const Vector3d& wanted) {
  constexpr int kTrials = 8000, kWide = 3000;  // the first are anywhere, the last very near to the best so far
  const JointVector low = arm.limits().min, high = arm.limits().max;
  JointVector best = arm.neutral().cwiseMax(low).cwiseMin(high), q = best;
  kinematics::Pose tip;
  if (!best.allFinite() || !arm.forward(best, tip)) return std::nullopt;
  Vector3d place = tip.position;
  std::mt19937_64 random(1);  // the same trials in every run
  for (int trial = 0; trial < kTrials; ++trial) {
    const double width = trial < kWide ? 1 : std::pow(1e-5, (trial - kWide + 0.0) / (kTrials - kWide));
    for (int i = 0; i < q.size(); ++i) {
      const double part = static_cast<double>(random() >> 11) * 0x1p-53;
      const double range = std::min(high[i] - low[i], 2 * M_PI);
      q[i] = std::clamp(best[i] + width * (2 * part - 1) * range, low[i], high[i]);
    }
    if (!arm.allowed(q) || !arm.forward(q, tip)) continue;
    if (!((tip.position - wanted).norm() < (place - wanted).norm())) continue;
    best = q, place = tip.position;
  }
  return inWholeMillimetres(arm, place, best);
}

}  // namespace hapticd::simulated
