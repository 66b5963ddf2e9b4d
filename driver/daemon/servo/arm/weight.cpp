// SPDX-License-Identifier: MIT
#include "servo/arm/weight.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

Weight::Weight(const scene::Limits& limits, double max_force)
    : most_(limits.weight.value_or(max_force > 0 ? max_force : HUGE_VAL)),
      ramp_in_(limits.ramp_in),
      ramp_out_(limits.ramp_out) {}

bool Weight::bound(Torques& torques, const TipJacobian& J, double allowed, double dt) noexcept HSP_RT {
  const double time = wanted_ ? ramp_in_ : ramp_out_, step = time > dt ? dt / time : 1;
  ramp_ = std::clamp(ramp_ + (wanted_ ? step : -step), 0.0, 1.0);
  const double ramped = std::min(ramp_, allowed);
  if (most_ == 0 || ramped == 0) {
    torques.fill(0);
    return false;
  }
  const double share = shareWithin(most_, torques, J);
  for (double& torque : torques) torque *= ramped * share;
  return share < 1;
}

double shareWithin(double most, const Weight::Torques& torques, const TipJacobian& J) noexcept HSP_RT {
  if (!(most < HUGE_VAL)) return 1;
  double largest = 0, lever = 0;
  for (Eigen::Index i = 0; i < J.cols(); ++i) {
    largest = std::max(largest, std::abs(torques[static_cast<size_t>(i)]));
    lever = std::max(lever, J.col(i).norm());
  }
  if (largest == 0) return 1;
  // Scaled down first, so that squares stay finite: a weight of 1e300 N is then bounded like any other.
  JointVector direction(J.cols());
  for (Eigen::Index i = 0; i < J.cols(); ++i) direction[i] = torques[static_cast<size_t>(i)] / largest;
  const double at_tip = largest * TipInverse(J).force(direction).norm();
  double share = largest > most * lever ? most * lever / largest : 1;
  if (at_tip * share > most) share = most / at_tip;
  return share;
}

}  // namespace hapticd::servo
