// SPDX-License-Identifier: MIT
#include "servo/core/path.hpp"

#include "servo/core/frame.hpp"

namespace hapticd::servo {

namespace {

void store(const Eigen::Vector3d& p, const Eigen::Quaterniond& q, hsp_pose& pose) noexcept {
  Eigen::Map<Eigen::Vector3d>(pose.position) = p;
  storeQuaternion(q, pose.orientation);
}

}  // namespace

void Path::at(double t, hsp_pose& pose) noexcept {
  Eigen::Map<Eigen::Vector3d> linear(pose.linear), angular(pose.angular);
  linear.setZero();
  angular.setZero();
  if (t <= points_.front().t || points_.size() == 1) {
    store(points_.front().pose.position, points_.front().pose.orientation, pose);
    return;
  }
  if (t >= points_.back().t) {
    store(points_.back().pose.position, points_.back().pose.orientation, pose);
    return;
  }
  if (points_[segment_].t > t) segment_ = 0;
  while (points_[segment_ + 1].t <= t) ++segment_;
  const scene::PathPoint &a = points_[segment_], &b = points_[segment_ + 1];
  const double duration = b.t - a.t, s = (t - a.t) / duration;
  store(a.pose.position + s * (b.pose.position - a.pose.position), a.pose.orientation.slerp(s, b.pose.orientation),
        pose);
  linear = (b.pose.position - a.pose.position) / duration;
  Eigen::Quaterniond turn = b.pose.orientation * a.pose.orientation.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();  // the shorter way round, as in slerp
  const Eigen::AngleAxisd angle_axis(turn);
  angular = angle_axis.axis() * (angle_axis.angle() / duration);
}

}  // namespace hapticd::servo
