// SPDX-License-Identifier: MIT
/// What presses on a moving body: contacts foreseen at the end of a step, with the way they give as the body moves.
#pragma once
#include <Eigen/Core>

#include "kernels/contact/wall.hpp"

namespace hapticd::dynamics {

/// A contact as the last step left it, world frame.
struct Pressing {
  Eigen::Vector3d probe{0, 0, 0};   ///< where the probe was [m]
  Eigen::Vector3d point{0, 0, 0};   ///< of the surface under it [m]
  Eigen::Vector3d normal{0, 0, 1};  ///< outward, unit
  Eigen::Vector3d along{0, 0, 0};   ///< friction on the probe, along the surface [N]
  contact::WallLaw law;
  double depth = 0;            ///< [m] > 0 inside; the touch of a probe just outside is foreseen
  double along_limit = 0;      ///< [N] the friction does not grow beyond this
  double along_stiffness = 0;  ///< [N/m] of the friction while it sticks
  double along_damping = 0;    ///< [N s/m]
};

/// One contact in the coming step, world frame. A force held through a step pushes the body on after it has given way:
/// that gains e^(pi w h/4) a half swing (w^2 = k/m, step h), without end for a light body. So the force at the step's
/// end is taken, and what the body's own change of velocity takes off it.
struct Press {
  Eigen::Vector3d point{0, 0, 0};                  ///< [m]
  Eigen::Vector3d outward{0, 0, 1};                ///< unit: no force ever pulls the body in this direction
  Eigen::Vector3d force{0, 0, 0};                  ///< on the body at the end of the step, if it keeps its velocity [N]
  Eigen::Matrix3d give = Eigen::Matrix3d::Zero();  ///< [N s/m] what a change of the point's velocity takes off
};

/// [rt] The contact `last` at the end of a step of dt [s].
/// @param probe_now where the probe is now [m]  @param closing_speed of probe against surface, > 0 going deeper [m/s]
/// @param point_velocity of the body at the contact [m/s]
Press foresee(const Pressing& last, const Eigen::Vector3d& probe_now, double closing_speed,
              const Eigen::Vector3d& point_velocity, double dt) noexcept;

/// [rt] The force on the body if the point's velocity changes by `change` [m/s] in the step: a wall does not pull.
Eigen::Vector3d forceAfter(const Press& press, const Eigen::Vector3d& change) noexcept;

}  // namespace hapticd::dynamics
