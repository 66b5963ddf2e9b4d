// SPDX-License-Identifier: MIT
/// A limiter that bounds nothing but what a test asks for.
#pragma once
#include "servo/safety/limiter.hpp"

namespace hapticd::servo {

inline scene::Limits generous() {
  scene::Limits limits;
  limits.ramp_in = 0;
  limits.slew = limits.torque_slew = 0;
  return limits;
}

/// One tick at the origin. @return the force that is left
inline Eigen::Vector3d limited(Limiter& limiter, Eigen::Vector3d force, double dt = 1e-3) {
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();
  limiter.apply(force, torque, Eigen::Vector3d::Zero(), dt);
  return force;
}

}  // namespace hapticd::servo
