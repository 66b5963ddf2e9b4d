// SPDX-License-Identifier: MIT
/// A pose that follows a leader in another process. Whatever targets the leader gives, the pose never moves faster than
/// is safe for a hand, and it comes to rest soon after the last record. No buffer adds a delay: between two records the
/// target moves on with the twist that the leader gave.
#pragma once
#include <Eigen/Geometry>

#include "hapticd/client.h"
#include "hapticd/shape.h"

namespace hapticd::servo {

class PoseFollower {
 public:
  static constexpr double kMostSpeed = 1.0;        ///< [m/s] highest speed of the pose
  static constexpr double kMostAcceleration = 20;  ///< [m/s^2] highest acceleration
  /// [rad/s] a surface 0.3 m from the model's origin stays below kMostSpeed
  static constexpr double kMostTurn = 3.141593;
  static constexpr double kMostTurnAcceleration = 60;  ///< [rad/s^2] highest angular acceleration
  static constexpr double kCloseIn = 0.02;             ///< [s] time constant with which an error decreases
  static constexpr double kTwistHolds = 0.1;           ///< [s] time for which the twist of a record is used
  /// [s] time in which the twist then fades to zero; so the motion goes on if two frames of 60 Hz are lost
  static constexpr double kTwistFades = 0.05;
  /// [m] a target farther from the world's origin is refused: no arm reaches so far
  static constexpr double kFarthest = 10;
  /// [s] a record may be this far in the future: a late tick sees records written after its time
  static constexpr double kAhead = 0.1;
  static constexpr double kUnitWithin = 1e-3;  ///< tolerance for the length of a quaternion

  /// Why a target is not followed.
  enum class Refusal : uint32_t { kNone, kNotFinite, kTime, kFar, kNotUnit };

  /// [rt] Returns why a target must not be followed, or kNone; see hapticd_target. @param now [s] CLOCK_MONOTONIC, as
  /// in the target
  static Refusal refusalOf(const hapticd_target& target, double now) noexcept HSP_RT;
  static bool sound(const hapticd_target& target, double now) noexcept HSP_RT {
    return refusalOf(target, now) == Refusal::kNone;
  }

  /// [rt] Starts from a pose and its velocities. Without a target, the motion brakes to rest.
  void begin(const hsp_pose& pose) noexcept HSP_RT;

  /// [rt] Takes a target that refusalOf() does not refuse. The target is the pose at time `t` [s] on the clock of
  /// step(). Returns false, and ignores the target, if it is older than the last one.
  bool aim(const hapticd_target& target, double t) noexcept HSP_RT;

  /// [rt] The leader has gone: the pose brakes, and stays where the braking ends.
  void release() noexcept HSP_RT { led_ = false; }

  /// [rt] One tick at t [s], dt [s] after the last one: moves, and fills in the pose and its velocities.
  void step(double t, double dt, hsp_pose& pose) noexcept HSP_RT;

  /// [rt] True if the pose stands still, and will do so until the next target.
  bool rests() const noexcept { return rests_; }

 private:
  using Vector3d = Eigen::Vector3d;
  void stepPosition(double trust, double reach, double dt) noexcept HSP_RT;
  void stepOrientation(double trust, double reach, double dt) noexcept HSP_RT;

  Vector3d p_ = Vector3d::Zero(), v_ = Vector3d::Zero(), w_ = Vector3d::Zero();  // world frame
  Eigen::Quaterniond q_ = Eigen::Quaterniond::Identity();
  Vector3d p_target_ = Vector3d::Zero(), v_target_ = Vector3d::Zero(), w_target_ = Vector3d::Zero();
  Eigen::Quaterniond q_target_ = Eigen::Quaterniond::Identity();
  double t_target_ = 0;
  bool led_ = false, rests_ = true;
};

}  // namespace hapticd::servo
