// SPDX-License-Identifier: MIT
#include "simulated/plant.hpp"

#include <gtest/gtest.h>

#include "simulated/mechanisms.hpp"

namespace hapticd::simulated {
namespace {

JointSettings frictionless(int count) {
  JointSettings joints;
  joints.step = joints.damping = joints.friction = joints.rotor = JointVector::Zero(count);
  joints.max_torque = JointVector::Constant(count, 1);
  return joints;
}

/// Largest change of kinetic energy in half a second of free flight without gravity.
double energyDrift(double h) {
  const kinematics::Phantom arm;
  PhantomMechanism mechanism(arm, {}, 0.2, Eigen::Vector3d::Zero());
  PlantOf<PhantomMechanism> plant(frictionless(3), mechanism);
  plant.reset(JointVector::Zero(3));
  Drive push{false, Eigen::Vector3d(0.3, 0.2, -0.1), JointVector::Zero(3), JointVector::Zero(3)}, none = push;
  none.torque.setZero();
  const HandCoupling away{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (int i = 0; i < 100; ++i) plant.step(1e-3, push, away);
  const auto energy = [&] {
    mechanism.evaluate(plant.position(), plant.velocity());
    return 0.5 * plant.velocity().dot(mechanism.M * plant.velocity());
  };
  const double before = energy();
  double worst = 0;
  for (double t = 0; t < 0.1; t += h) {
    plant.step(h, none, away);
    worst = std::max(worst, std::abs(energy() / before - 1));
  }
  return worst;
}

TEST(Plant, KeepsItsEnergyInTheLimitOfSmallSteps) {
  const double coarse = energyDrift(1e-4), fine = energyDrift(1e-5);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 10, 2);  // first order
}

TEST(Plant, SwingsOnAHandSpringAtTheRightFrequency) {
  // A heavy hand on a spring, small swing about the target along z: omega^2 = k / (m + mass of the arm at the tip).
  const kinematics::Phantom arm;
  PhantomMechanism mechanism(arm, {}, 2.0, Eigen::Vector3d::Zero());
  PlantOf<PhantomMechanism> plant(frictionless(3), mechanism);
  plant.reset(JointVector::Zero(3));
  mechanism.evaluate(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const Eigen::Matrix3d J_inverse = mechanism.J.inverse();
  const Eigen::Matrix3d mass = J_inverse.transpose() * mechanism.M * J_inverse;
  HandCoupling pull{Eigen::Vector3d(1e-4, 0, 0), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 800, 0};
  const Drive none{false, JointVector::Zero(3), JointVector::Zero(3), JointVector::Zero(3)};
  const double period = 2 * M_PI * std::sqrt(mass(0, 0) / 800);
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) plant.step(period / kSteps, none, pull);
  EXPECT_LT((arm.position(plant.position().head<3>())).norm(), 2e-6);  // back where it started
}

}  // namespace
}  // namespace hapticd::simulated
