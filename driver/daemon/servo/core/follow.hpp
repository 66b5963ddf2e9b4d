// SPDX-License-Identifier: MIT
/// A pose that follows a leader outside the process: never faster than a hand behind it can bear, whatever the leader
/// says, and at rest soon after the leader has fallen silent. There is no buffer and no added delay: between two
/// records the target goes on with the leader's own twist.
#pragma once
#include <Eigen/Geometry>

#include "hapticd/client.h"
#include "hapticd/shape.h"

namespace hapticd::servo {

class Follow {
 public:
  static constexpr double kMostSpeed = 1.0;            ///< [m/s]
  static constexpr double kMostAcceleration = 20;      ///< [m/s^2]
  static constexpr double kMostTurn = 3.141593;        ///< [rad/s] 0.3 m from its origin a surface keeps kMostSpeed
  static constexpr double kMostTurnAcceleration = 60;  ///< [rad/s^2]
  static constexpr double kCloseIn = 0.02;             ///< [s] time constant with which an error decreases
  static constexpr double kTwistHolds = 0.1;           ///< [s] for which the twist of a record holds,
  static constexpr double kTwistFades = 0.05;  ///< [s] over which it then fades: two lost frames of 60 Hz are bridged
  static constexpr double kFarthest = 10;      ///< [m] no arm reaches farther
  static constexpr double kAhead = 0.1;        ///< [s] a late tick may see records written after its time
  static constexpr double kUnitWithin = 1e-3;  ///< share of the length of a quaternion

  /// Why a target is not followed.
  enum class Refusal : uint32_t { kNone, kNotFinite, kTime, kFar, kNotUnit };

  /// [rt] Why a target may not be followed, or that it may; see hapticd_target. @param now [s] on the clock of its time
  static Refusal refusalOf(const hapticd_target& target, double now) noexcept HSP_RT;
  static bool sound(const hapticd_target& target, double now) noexcept HSP_RT {
    return refusalOf(target, now) == Refusal::kNone;
  }

  /// [rt] Starts from a pose and its velocities; while there is no target it comes to rest.
  void begin(const hsp_pose& pose) noexcept HSP_RT;

  /// [rt] A sound target, true at `t` [s] on the clock of step(). One older than the last is ignored: false.
  bool aim(const hapticd_target& target, double t) noexcept HSP_RT;

  /// [rt] The leader has gone: it brakes, and rests where that ends.
  void release() noexcept HSP_RT { led_ = false; }

  /// [rt] One tick at t [s], dt [s] after the last: moves on, and fills in pose and velocities.
  void step(double t, double dt, hsp_pose& pose) noexcept HSP_RT;

  /// [rt] True if it stands still, and will do so until another target comes.
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
