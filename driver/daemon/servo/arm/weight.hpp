// SPDX-License-Identifier: MIT
/// Limits the torques by which the motors carry the arm's own weight. They are calculated from the masses in a device
/// file, which may be wrong. So these torques are ramped like every force, and they never correspond to a force of more
/// than limits.weight at the tip.
#pragma once
#include <array>

#include "description/scene.hpp"
#include "servo/arm/tip_force.hpp"

namespace hapticd::servo {

class Weight {
 public:
  using Torques = std::array<double, HDV_MAX_JOINTS>;  ///< [N m], or [N] for a sliding joint

  /// [main] @param max_force [N] largest force of the arm, used if limits.weight is not given; 0: unknown, so there is
  /// no bound
  Weight(const scene::Limits& limits, double max_force);

  /// [rt] Sets whether the motors carry the weight. They stay off if nothing in the scene can be felt.
  void carry(bool wanted) noexcept HSP_RT { wanted_ = wanted; }

  /// [rt] Bounds and fades the torques that the kinematics ask for. Call it once per tick.
  /// @param J Jacobian of the tip, device frame @param allowed share of the full force that ramps and faults allow now,
  /// 0 to 1
  /// @return true if limits.weight reduced them
  bool bound(Torques& torques, const TipJacobian& J, double allowed, double dt) noexcept HSP_RT;

 private:
  double most_, ramp_in_, ramp_out_;
  double ramp_ = 0;
  bool wanted_ = false;
};

/// [rt] Returns the factor that reduces joint torques until they correspond to at most `most` [N] at the tip; 1 if they
/// are small enough already. The torque of a joint that hardly moves the tip is bounded by `most` times the longest
/// lever of the arm.
double shareWithin(double most, const Weight::Torques& torques, const TipJacobian& J) noexcept HSP_RT;

}  // namespace hapticd::servo
