// SPDX-License-Identifier: MIT
/// A plugin claims how stiff its shape is at most, and by its parameters in N s/m how much it damps. A force that grows
/// faster than that, times what the probe moved and how fast, is no answer of that shape: it is let through only as far
/// as the claim goes.
#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "hapticd/shape.h"

namespace hapticd::servo {

/// What is remembered of one model and one probe; everything in the model's frame.
class Claim {
 public:
  static constexpr double kMargin = 10;    ///< laws of contact are steeper in places than their authors think
  static constexpr double kStep = 2;       ///< [N] a click may be as sudden as this
  static constexpr double kDamping = 100;  ///< [N s/m] allowed to every shape: friction and inertia work like it

  /// [rt] How much of the force of `out` may be let through: 1 all of it. @param p_model where the probe is after the
  /// step @param in the probe as the step got it @param stiffness [N/m] and @param damping [N s/m] that the shape
  /// claims; no stiffness: no bound @param dt [s]
  double judge(const hsp_probe& in, const hsp_contact& out, const Eigen::Vector3d& p_model, double stiffness,
               double damping, double dt) noexcept HSP_RT {
    const Eigen::Vector3d velocity(in.velocity);
    const double asked = Eigen::Map<const Eigen::Vector3d>(out.force).norm();
    const bool traced = (out.flags & HSP_OUT_TRACED) != 0;
    double let = asked;
    // A surface found anew under the probe pushes at once; so does what lies where the probe jumped to.
    const bool comparable = known_ && stiffness > 0 && (in.flags & (HSP_IN_JUMP | HSP_IN_INVALID)) == 0;
    if (comparable) {
      const double way = (p_model - position_).norm();
      // A damper pushes with all of its force once its surface is met, and a body that damps itself sees the way alone.
      const double speed = std::max({velocity.norm(), velocity_.norm(), dt > 0 ? way / dt : 0.0});
      const double most = force_ + kStep + kMargin * stiffness * way +
                          std::max(kDamping * (velocity - velocity_).norm(), kMargin * damping * speed);
      let = std::min(asked, most);
    }
    known_ = traced && (in.flags & HSP_IN_INVALID) == 0;
    position_ = p_model;
    velocity_ = velocity;
    force_ = let;
    return asked > 0 ? let / asked : 1;
  }

  void forget() noexcept { known_ = false; }

 private:
  bool known_ = false;
  double force_ = 0;  // [N] let through
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace hapticd::servo
