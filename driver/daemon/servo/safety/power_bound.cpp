// SPDX-License-Identifier: MIT
#include "servo/safety/power_bound.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

void PowerBound::watch(const Eigen::Vector3d& velocity) noexcept HSP_RT {
  const Eigen::Vector3d now = velocity.allFinite() ? velocity : Eigen::Vector3d(Eigen::Vector3d::Zero());
  if (known_ && age_ > 0) acceleration_ = std::max(acceleration_, (now - velocity_).norm() / age_);
  known_ = true;
  velocity_ = now;
  age_ = 0;
}

void PowerBound::pass(double dt) noexcept HSP_RT {
  age_ += dt;
  dt_ = dt;
  acceleration_ *= std::max(0.0, 1 - dt / kRemember);
}

double PowerBound::most(const Eigen::Vector3d& direction, double power) const noexcept HSP_RT {
  const double ahead = lag_ + age_ + dt_;
  const double speed = direction.dot(velocity_) + kMargin * acceleration_ * ahead;
  // Solves F (v + F t/m) <= P for F, because the force makes a light arm fast before the next command.
  const double gain = mass_ > 0 ? ahead / mass_ : 0;
  if (gain <= 0) return speed > 0 ? power / speed : HUGE_VAL;
  return (std::sqrt(speed * speed + 4 * gain * power) - speed) / (2 * gain);
}

}  // namespace hapticd::servo
