// SPDX-License-Identifier: MIT
#include "servo/core/minimum_jerk.hpp"

#include <algorithm>

#include "servo/core/frame.hpp"

namespace hapticd::servo {

void MinimumJerk::begin(double t, double seconds, const hsp_pose& pose, const double* to_position,
                        const double* to_orientation) noexcept HSP_RT {
  begin_ = t;
  from_ = Eigen::Vector3d(pose.position);
  to_ = Eigen::Vector3d(to_position);
  q_from_ = quaternionOf(pose.orientation);
  q_to_ = quaternionOf(to_orientation);
  if (q_to_.squaredNorm() == 0) q_to_ = q_from_;
  if (q_from_.dot(q_to_) < 0) q_to_.coeffs() *= -1;  // turn the shorter way round
  const Eigen::AngleAxisd turn(q_to_ * q_from_.conjugate());
  turn_ = turn.angle() * turn.axis();
  const double distance = (to_ - from_).norm();
  const double asked = seconds > 0 ? seconds : std::max(kShortest, kPeakOfMean * distance / kMoveSpeed);
  seconds_ = std::max({asked, kPeakOfMean * distance / kMostSpeed, kPeakOfMean * turn.angle() / kMostTurn});
  active_ = true;
}

void MinimumJerk::at(double t, hsp_pose& pose) const noexcept HSP_RT {
  const double s = std::clamp((t - begin_) / seconds_, 0.0, 1.0);
  const double done = s * s * s * (10 + s * (6 * s - 15)), rate = 30 * s * s * (1 - s) * (1 - s) / seconds_;
  Eigen::Map<Eigen::Vector3d>(pose.position) = from_ + done * (to_ - from_);
  Eigen::Map<Eigen::Vector3d>(pose.linear) = rate * (to_ - from_);
  Eigen::Map<Eigen::Vector3d>(pose.angular) = rate * turn_;
  storeQuaternion(q_from_.slerp(done, q_to_), pose.orientation);
}

}  // namespace hapticd::servo
