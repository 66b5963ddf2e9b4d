// SPDX-License-Identifier: MIT
/// What a simulated arm is made of, with every per-joint list at its full length.
#pragma once
#include <cstdint>

#include "kinematics/arm.hpp"

namespace hapticd::simulated {

using kinematics::JointVector;

/// Drives and sensors of the joints; torques and inertias at the joint side of the gears.
struct JointSettings {
  JointVector step;                     ///< [rad] one encoder count; 0: exact
  JointVector damping, friction;        ///< [N m s/rad], [N m] Coulomb
  JointVector max_torque;               ///< [N m]
  JointVector rotor;                    ///< [kg m^2] of the motor, reflected
  JointVector stiffness, rate_damping;  ///< [N m/rad], [N m s/rad] of the arm's own position loop; empty: it has none
  double friction_speed = 0.1;          ///< [rad/s] at this rate Coulomb friction has three quarters of its full value
  double motor_lag = 0;                 ///< [s] electrical time constant
  double stop_stiffness = 200;          ///< [N m/rad] of the end stops
  double stop_damping = 0.5;            ///< [N m s/rad]
};

/// What acts on the arm during one integration step.
struct Drive {
  bool position_mode = false;
  JointVector torque, reference, reference_rate;  ///< [N m]; [rad]; [rad/s]
};

/// The hand at the tip during one integration step, interpolated within the servo period.
struct Pull {
  Eigen::Vector3d target, velocity, force;  ///< [m], [m/s], [N] beside spring and damper
  double stiffness = 0, damping = 0;        ///< [N/m], [N s/m]
};

}  // namespace hapticd::simulated
