// SPDX-License-Identifier: MIT
#include "kinematics/carried_bodies.hpp"

#include <stdexcept>
#include <string>

namespace hapticd::kinematics {

CarriedBodies::CarriedBodies(std::unique_ptr<Arm> arm, const JointLimits& others)
    : arm_(std::move(arm)), carrying_(arm_->jointCount()), others_(static_cast<int>(others.min.size())) {
  if (carrying_ + others_ > kMaxJoints)
    throw std::invalid_argument("an arm of " + std::to_string(carrying_ + others_) + " joints, expected at most " +
                                std::to_string(kMaxJoints));
  limits_.min.resize(carrying_ + others_);
  limits_.max.resize(carrying_ + others_);
  limits_.min << arm_->limits().min, others.min;
  limits_.max << arm_->limits().max, others.max;
}

bool CarriedBodies::forward(const JointVector& q, Pose& tip) const noexcept {
  return arm_->forward(q.head(carrying_), tip);
}

bool CarriedBodies::jacobian(const JointVector& q, Jacobian& J) const noexcept {
  Jacobian carrying;
  if (!arm_->jacobian(q.head(carrying_), carrying)) return false;
  J.setZero(6, carrying_ + others_);
  J.leftCols(carrying_) = carrying;
  return true;
}

bool CarriedBodies::gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept {
  JointVector carrying;
  if (!arm_->gravity(q.head(carrying_), gravity, carrying)) return false;
  tau.setZero(carrying_ + others_);
  tau.head(carrying_) = carrying;
  return true;
}

bool CarriedBodies::inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept {
  JointVector carrying = q.head(carrying_);
  if (!arm_->inverse(position, carrying)) return false;
  q.head(carrying_) = carrying;
  return true;
}

JointVector CarriedBodies::neutral() const noexcept {
  JointVector q(carrying_ + others_);
  q << arm_->neutral(), 0.5 * (limits_.min.tail(others_) + limits_.max.tail(others_));
  return q;
}

}  // namespace hapticd::kinematics
