// SPDX-License-Identifier: MIT
/// Finds a shape of the wrong sign: one that draws the probe deeper instead of pushing it out.
///
/// A contact begins with no stored energy, so nothing that only answers the probe can have given work to it since then.
/// A detent pulls for some of its way, but gives back no more than its press took. A force of the wrong sign gives work
/// from the first tick on, and the deeper the probe is, the more.
#pragma once
#include <Eigen/Core>
#include <algorithm>

#include "hapticd/shape.h"

namespace hapticd::servo {

/// What is remembered of one model and one probe; everything in the model's frame.
class Pull {
 public:
  static constexpr double kEnergy = 0.5e-3;  ///< [J] an 800 N/m spring of 1.1 mm: 0.9 N
  static constexpr int kTicks = 3;           ///< an edge may look like a pull for one tick
  /// [J] a contact that begins deep may have stored as much as its spring; a wrong depth must not excuse everything.
  static constexpr double kMostCredit = 10e-3;

  /// [rt] True if the answer of this tick drew the probe in, as those before it did. @param p_model where the probe is
  /// after the step @param in the probe as the step got it @param stiffness [N/m] that the shape claims
  bool judge(const hsp_probe& in, const hsp_contact& out, const Eigen::Vector3d& p_model,
             double stiffness) noexcept HSP_RT {
    constexpr uint32_t kBoth = HSP_OUT_CONTACT | HSP_OUT_TRACED;
    if ((out.flags & kBoth) != kBoth || (in.flags & (HSP_IN_JUMP | HSP_IN_INVALID)) != 0) return forget(), false;
    const Eigen::Vector3d normal(out.normal);
    const Eigen::Vector3d force = Eigen::Vector3d(out.force).dot(normal) * normal;
    if (known_) {
      take(0.5 * (force_ + force).dot(p_model - position_), out.depth_m > depth_);
    } else {
      work_ = -std::min(0.5 * stiffness * out.depth_m * out.depth_m, kMostCredit);
    }
    known_ = true;
    position_ = p_model;
    force_ = force;
    depth_ = out.depth_m;
    return ticks_ >= kTicks && pulled_ > kEnergy && work_ > kEnergy;
  }

  void forget() noexcept { *this = Pull{}; }

 private:
  /// The mean force of both ends times the way: exact for a spring, so that the sum does not drift.
  void take(double work, bool deeper) noexcept {
    work_ += work;
    if (!deeper || work == 0) return;
    pulled_ = work > 0 ? pulled_ + work : 0;
    ticks_ = work > 0 ? ticks_ + 1 : 0;
  }

  bool known_ = false;
  int ticks_ = 0;                 // that pulled, since the last that pushed
  double work_ = 0, pulled_ = 0;  // [J] given to the hand since the contact began; in those ticks
  double depth_ = 0;              // [m] of the last tick
  Eigen::Vector3d position_ = Eigen::Vector3d::Zero(), force_ = Eigen::Vector3d::Zero();
};

}  // namespace hapticd::servo
