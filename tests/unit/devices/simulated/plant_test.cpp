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

/// Largest change of kinetic energy in a tenth of a second of free flight without gravity.
template <class Mechanism>
double energyDrift(Mechanism mechanism, const JointVector& begin, const Eigen::Vector3d& torque, double h) {
  PlantOf<Mechanism> plant(frictionless(3), mechanism);
  plant.reset(begin);
  Drive push{false, torque, JointVector::Zero(3), JointVector::Zero(3)}, none = push;
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
  const PhantomMechanism mechanism(kinematics::Phantom(), {}, 0.2, Eigen::Vector3d::Zero());
  const Eigen::Vector3d torque(0.3, 0.2, -0.1);
  const double coarse = energyDrift(mechanism, JointVector::Zero(3), torque, 1e-4),
               fine = energyDrift(mechanism, JointVector::Zero(3), torque, 1e-5);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 10, 2);  // first order
}

TEST(Plant, ADeltaKeepsItsEnergyInTheLimitOfSmallSteps) {
  const kinematics::Delta arm;
  const DeltaMechanism mechanism(arm, Eigen::Vector3d::Constant(2e-4), 0.6, Eigen::Vector3d::Zero());
  const Eigen::Vector3d torque(0.06, 0.04, -0.02);  // N m: it reaches no stop within the time
  const double coarse = energyDrift(mechanism, arm.neutral(), torque, 1e-4),
               fine = energyDrift(mechanism, arm.neutral(), torque, 1e-5);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / fine, 10, 2);  // first order
}

/// A hand that pulls farther than the arm reaches leaves it at its end: finite, and back as soon as the hand is.
TEST(Plant, ADeltaStaysInOnePiece) {
  const kinematics::Delta arm;
  JointSettings joints = frictionless(3);
  joints.damping.setConstant(0.005);
  PlantOf<DeltaMechanism> plant(
      joints, DeltaMechanism(arm, Eigen::Vector3d::Constant(2e-4), 0.2, Eigen::Vector3d(0, -9.81, 0)));
  plant.reset(arm.neutral());
  const Eigen::Vector3d middle = plant.tip();
  const Drive none{false, JointVector::Zero(3), JointVector::Zero(3), JointVector::Zero(3)};
  for (const Eigen::Vector3d& pulled :
       {Eigen::Vector3d(0, 0, 0.4), Eigen::Vector3d(0.3, 0, 0), Eigen::Vector3d(0, -0.3, 0.2),
        Eigen::Vector3d(0, 0, -0.4), Eigen::Vector3d(-0.2, 0.2, -0.1)}) {
    HandCoupling pull{middle + pulled, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 500, 5};
    for (int i = 0; i < 5000; ++i) plant.step(2e-4, none, pull);
    ASSERT_TRUE(plant.position().allFinite()) << pulled.transpose();
    EXPECT_LT((plant.tip() - middle).norm(), 0.2) << pulled.transpose();
    pull.target = middle;
    for (int i = 0; i < 10000; ++i) plant.step(2e-4, none, pull);
    EXPECT_LT((plant.tip() - middle).norm(), 0.005) << pulled.transpose();
  }
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
