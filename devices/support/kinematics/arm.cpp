// SPDX-License-Identifier: MIT
#include "kinematics/arm.hpp"

#include <stdexcept>
#include <string>

namespace hapticd::kinematics {

void Arm::narrow(const JointLimits& limits) {
  for (Eigen::Index i = 0; i < limits.min.size(); ++i)
    if (limits.min.size() != jointCount() || !(limits.min[i] <= limits.max[i]))
      throw std::invalid_argument("arm.limits: row " + std::to_string(i + 1) + " of " +
                                  std::to_string(limits.min.size()) + ", expected " + std::to_string(jointCount()) +
                                  " rows, each the smaller one first");
  limits_ = limits;
}

bool Arm::allowed(const JointVector& q) const noexcept {
  return q.size() == jointCount() && (q.array() >= limits_.min.array()).all() &&
         (q.array() <= limits_.max.array()).all();
}

}  // namespace hapticd::kinematics
