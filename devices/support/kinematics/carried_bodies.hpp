// SPDX-License-Identifier: MIT
/// An arm with further joints that do not carry its tip, such as the thumb of an exoskeleton. These joints are measured
/// and have motors, but a force at the tip gives them no torque. Their weight counts as part of the link to which they
/// are attached.
#pragma once
#include <memory>

#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

class CarriedBodies : public Arm {
 public:
  /// @param others limits of the further joints, which come after the joints of `arm`. Throws std::invalid_argument.
  CarriedBodies(std::unique_ptr<Arm> arm, const JointLimits& others);

  int jointCount() const noexcept override { return carrying_ + others_; }
  bool forward(const JointVector& q, Pose& tip) const noexcept override;
  bool jacobian(const JointVector& q, Jacobian& J) const noexcept override;
  bool gravity(const JointVector& q, const Eigen::Vector3d& gravity, JointVector& tau) const noexcept override;
  /// Leaves the further joints of q unchanged.
  bool inverse(const Eigen::Vector3d& position, JointVector& q) const noexcept override;
  JointVector neutral() const noexcept override;

 private:
  std::unique_ptr<Arm> arm_;
  int carrying_, others_;
};

}  // namespace hapticd::kinematics
