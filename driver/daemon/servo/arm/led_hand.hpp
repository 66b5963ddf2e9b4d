// SPDX-License-Identifier: MIT
/// The hand of a simulated arm, led by a program. The program sets the position to which the hand wants to go, and the
/// simulated hand moves there by its own mass, spring and damper.
#pragma once
#include <Eigen/Geometry>

#include "hapticd/device.h"
#include "servo/core/led_pose.hpp"

namespace hapticd::servo {

class LedHand {
 public:
  /// [main] @param hand the device's extension; nullptr if there is none, as in a replay: the motion is then
  /// calculated, but no hand follows it
  LedHand(const hdv_ext_hand* hand, hdv_device* device, const Eigen::Matrix3d& R_world_device,
          const Eigen::Vector3d& origin_world)
      : hand_(hand), device_(device), R_world_device_(R_world_device), origin_world_(origin_world) {}

  /// [any] True if the hand can follow a leader.
  bool guided() const noexcept { return hand_ != nullptr && hand_->guided(device_) != 0; }
  bool led() const noexcept { return lead_.led(); }

  /// [rt] A leader begins. @param tip [m] position of the tip, world frame: the motion begins here, if no program has
  /// led the hand before
  void begin(const link::PoseSlot& slot, const Eigen::Vector3d& tip) noexcept HSP_RT {
    if (!lead_.active()) {
      Eigen::Map<Eigen::Vector3d>(pose_.position) = tip;
      pose_.orientation[0] = 1;
    }
    lead_.begin(slot, pose_);
  }
  void end() noexcept HSP_RT { lead_.end(); }  ///< [rt] the leader has gone: the hand brakes and stays

  /// [rt] Called before the arm is read at t [s], dt [s] after the last tick. @param epoch CLOCK_MONOTONIC [s] at t = 0
  void step(double t, double dt, double epoch) noexcept HSP_RT {
    if (!lead_.active()) return;
    lead_.step(t, dt, epoch, pose_);
    if (hand_ == nullptr) return;
    const Eigen::Map<const Eigen::Vector3d> p_world(pose_.position), v_world(pose_.linear);
    const Eigen::Vector3d p_device = R_world_device_.transpose() * (p_world - origin_world_);
    const Eigen::Vector3d v_device = R_world_device_.transpose() * v_world;
    constexpr double kNoForce[3] = {};
    hand_->guide(device_, p_device.data(), v_device.data(), kNoForce);
  }

  const hapticd_target* taken() const noexcept { return lead_.taken(); }  ///< record of the last step, or nullptr
  uint64_t refused() const noexcept { return lead_.refused(); }
  PoseFollower::Refusal why() const noexcept { return lead_.why(); }  ///< reason of the last refusal

 private:
  const hdv_ext_hand* hand_;
  hdv_device* device_;
  Eigen::Matrix3d R_world_device_;
  Eigen::Vector3d origin_world_;
  LedPose lead_{LedPose::Turns::kNever};
  hsp_pose pose_{};
};

}  // namespace hapticd::servo
