// SPDX-License-Identifier: MIT
#include "servo/core/pose_follower.hpp"

#include <algorithm>
#include <cmath>

#include "servo/core/frame.hpp"

namespace hapticd::servo {

namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// [m], [rad] nearer than this to a resting target, the motion ends; no encoder resolves less
constexpr double kThere = 1e-9;

bool finite(const double* values, int count) noexcept HSP_RT {
  for (int i = 0; i < count; ++i)
    if (!std::isfinite(values[i])) return false;
  return true;
}

/// Shortens a vector to a length of at most `most`, also if its squares overflow.
Vector3d capped(Vector3d v, double most) noexcept HSP_RT {
  const double largest = v.cwiseAbs().maxCoeff();
  if (largest > most) v *= most / largest;
  const double norm = v.norm();
  return norm > most ? Vector3d(v * (most / norm)) : v;
}

/// Returns the rotation vector of a quaternion, for the shorter way round.
Vector3d rotationVector(const Quaterniond& turn) noexcept HSP_RT {
  const double sine = turn.vec().norm();
  if (sine == 0) return Vector3d::Zero();
  const double sign = turn.w() < 0 ? -1 : 1;
  return turn.vec() * (sign * 2 * std::atan2(sine, std::abs(turn.w())) / sine);
}

Quaterniond turnBy(const Vector3d& rotation) noexcept HSP_RT {
  const double angle = rotation.norm();
  if (angle == 0) return Quaterniond::Identity();
  Quaterniond turn;
  turn.w() = std::cos(0.5 * angle);
  turn.vec() = rotation * (std::sin(0.5 * angle) / angle);
  return turn;
}

/// Returns for how many seconds at its full twist a target has moved on, `age` [s] after the time of its record. This
/// is less than `age` once the twist fades.
double reachOf(double age) noexcept HSP_RT {
  const double fading = std::clamp(age - PoseFollower::kTwistHolds, 0.0, PoseFollower::kTwistFades);
  return std::min(age, PoseFollower::kTwistHolds) + fading * (1 - 0.5 * fading / PoseFollower::kTwistFades);
}

struct Bounds {
  double speed, acceleration;
};

/// Velocities of the pose and of its target, and the error between them, for the position or for the rotation.
struct Motion {
  Vector3d velocity;   ///< now
  Vector3d of_target;  ///< mean velocity of the target over this tick
  Vector3d error;      ///< difference from the pose now to the target after this tick
};

/// True if the pose has reached a resting target, so that the motion can end. An exponential approach never ends.
bool arrived(const Motion& motion, const Bounds& most, double dt) noexcept HSP_RT {
  return motion.of_target.isZero(0) && motion.error.norm() <= kThere &&
         motion.velocity.norm() <= most.acceleration * dt;
}

/// Returns the velocity over the tick: that of the target, plus a velocity that reduces the error and can still be
/// braked. With sqrt(a e), braking needs half of the acceleration, and the rest is left for a target that moves.
Vector3d nextVelocity(const Motion& motion, const Bounds& most, double dt) noexcept HSP_RT {
  const Vector3d behind = motion.error - dt * motion.of_target;
  const double distance = behind.norm();
  Vector3d wanted = motion.of_target;
  if (distance > 0) {
    const double close_in = std::max(PoseFollower::kCloseIn, 2 * dt);  // no tick may go past the target
    wanted += behind * (std::min(distance / close_in, std::sqrt(most.acceleration * distance)) / distance);
  }
  return motion.velocity + capped(capped(wanted, most.speed) - motion.velocity, most.acceleration * dt);
}

constexpr Bounds kLinear{PoseFollower::kMostSpeed, PoseFollower::kMostAcceleration};
constexpr Bounds kAngular{PoseFollower::kMostTurn, PoseFollower::kMostTurnAcceleration};

}  // namespace

PoseFollower::Refusal PoseFollower::refusalOf(const hapticd_target& target, double now) noexcept HSP_RT {
  const bool numbers = finite(target.position, 3) && finite(target.orientation, 4) && finite(target.linear, 3) &&
                       finite(target.angular, 3) && std::isfinite(target.time);
  if (!numbers) return Refusal::kNotFinite;
  if (target.time < 0 || target.time > now + kAhead) return Refusal::kTime;
  const Eigen::Map<const Vector3d> position(target.position);
  if (position.cwiseAbs().maxCoeff() > kFarthest || position.norm() > kFarthest) return Refusal::kFar;
  const Eigen::Map<const Eigen::Vector4d> q(target.orientation);
  const bool unit = q.cwiseAbs().maxCoeff() < 2 && std::abs(q.norm() - 1) <= kUnitWithin;
  return unit ? Refusal::kNone : Refusal::kNotUnit;
}

void PoseFollower::begin(const hsp_pose& pose) noexcept HSP_RT {
  p_ = Vector3d(pose.position);
  v_ = Vector3d(pose.linear);
  w_ = Vector3d(pose.angular);
  q_ = quaternionOf(pose.orientation).normalized();
  led_ = rests_ = false;
}

bool PoseFollower::aim(const hapticd_target& target, double t) noexcept HSP_RT {
  if (led_ && t < t_target_) return false;
  p_target_ = Vector3d(target.position);
  v_target_ = capped(Vector3d(target.linear), kMostSpeed);
  w_target_ = capped(Vector3d(target.angular), kMostTurn);
  q_target_ = quaternionOf(target.orientation).normalized();
  t_target_ = t;
  led_ = true;
  rests_ = false;
  return true;
}

void PoseFollower::step(double t, double dt, hsp_pose& pose) noexcept HSP_RT {
  if (rests_) return;
  const double reach = reachOf(t - t_target_);
  // The mean twist over the tick, not the twist now, so that a leader of constant velocity is followed without error.
  const double trust = dt > 0 ? (reach - reachOf(t - t_target_ - dt)) / dt : 0;
  stepPosition(trust, reach, dt);
  stepOrientation(trust, reach, dt);
  Eigen::Map<Vector3d>(pose.position) = p_;
  Eigen::Map<Vector3d>(pose.linear) = v_;
  Eigen::Map<Vector3d>(pose.angular) = w_;
  storeQuaternion(q_, pose.orientation);
  const bool still = v_.isZero(0) && w_.isZero(0);
  const bool target_still = trust == 0 || (v_target_.isZero(0) && w_target_.isZero(0));
  rests_ = dt > 0 && still && (!led_ || target_still);
}

void PoseFollower::stepPosition(double trust, double reach, double dt) noexcept HSP_RT {
  Motion motion{v_, Vector3d::Zero(), Vector3d::Zero()};
  if (led_) {
    motion.of_target = trust * v_target_;
    motion.error = p_target_ + reach * v_target_ - p_;
  }
  if (arrived(motion, kLinear, dt)) {
    p_ += motion.error;
    v_.setZero();
    return;
  }
  v_ = nextVelocity(motion, kLinear, dt);
  p_ += dt * v_;
}

void PoseFollower::stepOrientation(double trust, double reach, double dt) noexcept HSP_RT {
  Motion motion{w_, Vector3d::Zero(), Vector3d::Zero()};
  const Quaterniond goal = led_ ? turnBy(reach * w_target_) * q_target_ : q_;
  if (led_) {
    motion.of_target = trust * w_target_;
    motion.error = rotationVector(goal * q_.conjugate());
  }
  if (arrived(motion, kAngular, dt)) {
    q_ = goal;
    w_.setZero();
    return;
  }
  w_ = nextVelocity(motion, kAngular, dt);
  q_ = (turnBy(dt * w_) * q_).normalized();
}

}  // namespace hapticd::servo
