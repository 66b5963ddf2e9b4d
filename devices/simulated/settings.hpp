// SPDX-License-Identifier: MIT
/// Properties of a simulated arm. Each list has one number for each joint.
#pragma once

#include "kinematics/arm.hpp"

namespace hapticd::simulated {

using kinematics::JointVector;

/// Motors and sensors of the joints. Torques and inertias are given at the joint, behind the gear.
struct JointSettings {
  JointVector step;                     ///< [rad] one encoder count; 0 if positions are exact
  JointVector damping, friction;        ///< [N m s/rad] viscous, [N m] Coulomb
  JointVector max_torque;               ///< [N m]
  JointVector rotor;                    ///< [kg m^2] inertia that the motor adds to the joint through the gear
  JointVector stiffness, rate_damping;  ///< [N m/rad], [N m s/rad] arm's own position loop; empty if it has no loop
  double friction_speed = 0.1;          ///< [rad/s] at this rate Coulomb friction has three quarters of its full value
  double motor_lag = 0;                 ///< [s] electrical time constant
  double stop_stiffness = 200;          ///< [N m/rad] stiffness of the end stops
  double stop_damping = 0.5;            ///< [N m s/rad] damping of the end stops
};

/// What the motors receive during one integration step.
struct Drive {
  bool position_mode = false;
  JointVector torque, reference, reference_rate;  ///< [N m]; [rad]; [rad/s]
};

/// The pull of the hand at the tip during one integration step. It is interpolated within the servo period.
struct HandCoupling {
  Eigen::Vector3d target, velocity, force;  ///< [m], [m/s], [N] in addition to spring and damper
  double stiffness = 0, damping = 0;        ///< [N/m], [N s/m]
};

}  // namespace hapticd::simulated
