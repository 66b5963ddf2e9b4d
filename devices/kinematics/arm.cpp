#include "kinematics/arm.hpp"

namespace hapticd::kinematics {

bool Arm::allowed(const JointVector& q) const noexcept {
  return q.size() == jointCount() && (q.array() >= limits_.min.array()).all() &&
         (q.array() <= limits_.max.array()).all();
}

}  // namespace hapticd::kinematics
