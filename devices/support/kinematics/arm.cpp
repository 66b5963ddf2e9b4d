// SPDX-License-Identifier: MIT
#include "kinematics/arm.hpp"

#include <cstdio>
#include <string>

#include "kinematics/error_collector.hpp"

namespace hapticd::kinematics {

void Arm::narrow(const JointLimits& limits) {
  const auto text = [](double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%g", value);
    return std::string(buffer);
  };
  ErrorCollector wrong;
  if (limits.min.size() != jointCount())
    wrong.add("arm.limits: " + std::to_string(limits.min.size()) + " rows, expected " + std::to_string(jointCount()) +
              ": one for each joint");
  for (Eigen::Index i = 0; i < limits.min.size(); ++i)
    if (!(limits.min[i] <= limits.max[i]))
      wrong.add("arm.limits[" + std::to_string(i) + "]: [" + text(limits.min[i]) + ", " + text(limits.max[i]) +
                "], expected the smaller number first");
  wrong.check();
  limits_ = limits;
}

bool Arm::allowed(const JointVector& q) const noexcept {
  return q.size() == jointCount() && (q.array() >= limits_.min.array()).all() &&
         (q.array() <= limits_.max.array()).all();
}

}  // namespace hapticd::kinematics
