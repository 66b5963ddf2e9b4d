/// A kinematic model on its way to where a person asked it to go: smooth, and with the velocities that contacts need.
#pragma once
#include <Eigen/Geometry>
#include <algorithm>

#include "hapticd/shape.h"

namespace hapticd::servo {

class Glide {
 public:
  bool active() const noexcept { return active_; }

  /// [rt] From `pose` to another, beginning at t [s]. @param to_orientation w,x,y,z, a unit quaternion
  void begin(double t, double seconds, const hsp_pose& pose, const double* to_position,
             const double* to_orientation) noexcept HSP_RT {
    begin_ = t;
    seconds_ = std::max(seconds, 1e-3);
    from_ = Eigen::Vector3d(pose.position);
    to_ = Eigen::Vector3d(to_position);
    q_from_ = quaternion(pose.orientation);
    q_to_ = quaternion(to_orientation);
    if (q_from_.dot(q_to_) < 0) q_to_.coeffs() *= -1;  // the short way round
    const Eigen::AngleAxisd turn(q_to_ * q_from_.conjugate());
    turn_ = turn.angle() * turn.axis();
    active_ = true;
  }

  /// [rt] Pose and velocities at t: the path of least jerk, at rest at both ends.
  void at(double t, hsp_pose& pose) const noexcept HSP_RT {
    const double s = std::clamp((t - begin_) / seconds_, 0.0, 1.0);
    const double done = s * s * s * (10 + s * (6 * s - 15)), rate = 30 * s * s * (1 - s) * (1 - s) / seconds_;
    const Eigen::Quaterniond q = q_from_.slerp(done, q_to_);
    Eigen::Map<Eigen::Vector3d>(pose.position) = from_ + done * (to_ - from_);
    Eigen::Map<Eigen::Vector3d>(pose.linear) = rate * (to_ - from_);
    Eigen::Map<Eigen::Vector3d>(pose.angular) = rate * turn_;
    pose.orientation[0] = q.w(), pose.orientation[1] = q.x(), pose.orientation[2] = q.y(), pose.orientation[3] = q.z();
  }

 private:
  static Eigen::Quaterniond quaternion(const double* q) noexcept { return {q[0], q[1], q[2], q[3]}; }

  bool active_ = false;
  double begin_ = 0, seconds_ = 1;
  Eigen::Vector3d from_ = Eigen::Vector3d::Zero(), to_ = Eigen::Vector3d::Zero(), turn_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_from_ = Eigen::Quaterniond::Identity(), q_to_ = Eigen::Quaterniond::Identity();
};

}  // namespace hapticd::servo
