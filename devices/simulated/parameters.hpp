// SPDX-License-Identifier: MIT
/// The parameters of a simulated arm as the device file gives them, and functions that make settings and models from
/// them.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "kinematics/chain.hpp"
#include "kinematics/delta.hpp"
#include "kinematics/phantom.hpp"
#include "simulated/hand.hpp"
#include "simulated/plant.hpp"

namespace hapticd::simulated {

enum class Kind { kPremium15, kChain, kPhantom, kDelta };

struct Parameters {
  int seed = 1, kind = 0, delay = 0;
  double substep = 2e-4;
  // arm
  std::array<double, 3> origin{}, base_position{}, tool_position{};
  std::vector<double> base_orientation, dh, limits, masses, centers, inertias, lengths, angles, arm_torque;
  // joint: lists of one number for all joints, or of one number per joint
  std::vector<double> gear, counts, damping, friction, max_torque, rotor, stiffness, rate_damping;
  double motor_lag = 0, friction_speed = 0, torque_noise = 0;
  bool torque_sensors = false;
  // device facts
  double rate = 0, max_force = 0, continuous_force = 0, max_stiffness = 0, felt_mass = 0;
  // hand
  int script = 0;
  double mass = 0, hand_stiffness = 0, hand_damping = 0, radius = 0, sweep = 0, rise = 0, hand_rate = 0;
  double approach = 0, lead_in = 0, tremor = 0, wander = 0;
  std::array<double, 3> center{}, normal{}, axis{};
  std::string path;
  std::vector<double> pressed, unplugged;  ///< [s] begin, end, begin, end, ...

  Kind arm() const { return static_cast<Kind>(kind); }
};

/// Returns the chain that arm.dh and the other arm lists describe. Throws std::invalid_argument with a message for the
/// user.
kinematics::ChainGeometry chainOf(const Parameters& p);
kinematics::PhantomGeometry phantomOf(const Parameters& p);
kinematics::DeltaGeometry deltaOf(const Parameters& p);
JointSettings jointsOf(const Parameters& p, int count);
HandSettings handOf(const Parameters& p);

/// [main] Makes the kinematics of the arm from its parameters.
std::unique_ptr<kinematics::Arm> makeArm(const Parameters& p);
/// [main] Makes the dynamics of the arm. @param gravity [m/s^2] device frame
std::unique_ptr<Plant> makePlant(const Parameters& p, const JointSettings& joints, const Eigen::Vector3d& gravity);

}  // namespace hapticd::simulated
