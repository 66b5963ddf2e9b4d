// SPDX-License-Identifier: MIT
/// The torques that carry the arm's own weight. They come from the masses in a device file, which may be wrong: so they
/// are ramped like every force, and never amount to more at the tip than limits.weight.
#pragma once
#include <array>

#include "description/scene.hpp"
#include "servo/arm/tip_force.hpp"

namespace hapticd::servo {

class Weight {
 public:
  using Torques = std::array<double, HDV_MAX_JOINTS>;  ///< [N m], or [N] for a sliding joint

  /// [main] @param max_force [N] of the arm, used where limits.weight is not given; 0: unknown, no bound
  Weight(const scene::Limits& limits, double max_force);

  /// [rt] Whether the arm is carried at all: if nothing in the scene can be felt, its motors stay off.
  void carry(bool wanted) noexcept HSP_RT { wanted_ = wanted; }

  /// [rt] The torques of this tick: what the kinematics ask for, bounded and faded. Call once a tick.
  /// @param J of the tip, device frame @param allowed share of a full force that ramps and faults allow now, 0 to 1
  /// @return true if limits.weight made them smaller
  bool bound(Torques& torques, const TipJacobian& J, double allowed, double dt) noexcept HSP_RT;

 private:
  double most_, ramp_in_, ramp_out_;
  double ramp_ = 0;
  bool wanted_ = false;
};

/// [rt] The factor that reduces joint torques to `most` [N] at the tip; 1 where they amount to less. A joint that
/// hardly moves the tip may not have more than `most` times the longest lever of the arm.
double shareWithin(double most, const Weight::Torques& torques, const TipJacobian& J) noexcept HSP_RT;

}  // namespace hapticd::servo
