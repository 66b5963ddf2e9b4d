// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <memory>

#include "example_chain.hpp"
#include "kinematics/delta.hpp"
#include "kinematics/phantom.hpp"
#include "numeric.hpp"

namespace hapticd::kinematics {
namespace {

constexpr int kPoses = 300;
const Eigen::Vector3d kGravity(0.7, -9.7, 1.1);

std::unique_ptr<Arm> tiltedDelta() {
  DeltaGeometry geometry;
  geometry.base.position = Eigen::Vector3d(0.01, 0.02, -0.11);
  geometry.base.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 1, 0).normalized()));
  return std::make_unique<Delta>(geometry);
}

struct Named {
  const char* name;
  std::unique_ptr<Arm> (*make)();
};

const Named kArms[] = {
    {"Phantom", [] { return std::unique_ptr<Arm>(std::make_unique<Phantom>()); }},
    {"Chain", [] { return std::unique_ptr<Arm>(std::make_unique<Chain>(exampleChain())); }},
    {"ChainWithSlider", [] { return std::unique_ptr<Arm>(std::make_unique<Chain>(exampleChain(true))); }},
    {"Delta", [] { return std::unique_ptr<Arm>(std::make_unique<Delta>()); }},
    {"TiltedDelta", tiltedDelta},
};

class EveryArm : public testing::TestWithParam<Named> {
 protected:
  std::unique_ptr<Arm> arm_ = GetParam().make();
  RandomJoints random_{*arm_};
};

TEST_P(EveryArm, HasTheJacobianThatDifferentiationGives) {
  for (int n = 0; n < kPoses; ++n) {
    const JointVector q = random_.next();
    Jacobian J, truth = numericJacobian(*arm_, q);
    ASSERT_TRUE(arm_->jacobian(q, J));
    // Near a singular pose of a delta all derivatives grow, and with them the error of the differences.
    const bool delta = std::string(GetParam().name).find("Delta") != std::string::npos;
    const double tolerance = delta ? 2e-10 * std::max(1.0, std::pow(J.norm() * 4, 4)) : 2e-11;
    EXPECT_LT((J - truth).cwiseAbs().maxCoeff(), tolerance) << q.transpose();
  }
}

TEST_P(EveryArm, FindsJointsThatReachWhereItsTipWas) {
  for (int n = 0; n < kPoses; ++n) {
    const JointVector q = random_.next();
    Pose tip, found;
    ASSERT_TRUE(arm_->forward(q, tip));
    JointVector start = q + 0.2 * JointVector::Ones(q.size());
    start = start.cwiseMin(arm_->limits().max);
    ASSERT_TRUE(arm_->inverse(tip.position, start)) << q.transpose();
    ASSERT_TRUE(arm_->forward(start, found));
    EXPECT_LE((found.position - tip.position).norm(), 1e-12) << q.transpose();
    EXPECT_TRUE(arm_->allowed(start));
  }
}

TEST_P(EveryArm, NeverReachesAPointWithAJointBeyondItsLimits) {
  int refused = 0;
  for (int n = 0; n < kPoses; ++n) {
    JointVector q = random_.next(), found = arm_->neutral();
    const Eigen::Index joint = n % q.size();
    const double beyond = 0.05 * (1 + n % 4);
    q[joint] = n % 2 == 0 ? arm_->limits().max[joint] + beyond : arm_->limits().min[joint] - beyond;
    Pose tip;
    if (!arm_->forward(q, tip)) continue;
    const bool reached = arm_->inverse(tip.position, found);
    EXPECT_TRUE(!reached || arm_->allowed(found)) << q.transpose();
    refused += reached ? 0 : 1;
  }
  EXPECT_GT(refused, 0);
}

TEST_P(EveryArm, SaysWhenAPointIsOutOfReachAndKeepsTheJoints) {
  JointVector q = arm_->neutral();
  EXPECT_FALSE(arm_->inverse(Eigen::Vector3d(5, 5, 5), q));
  EXPECT_FALSE(arm_->inverse(Eigen::Vector3d::Constant(std::nan("")), q));
  EXPECT_EQ(q, arm_->neutral());
}

TEST_P(EveryArm, HoldsItselfAgainstGravityFromAnyDirection) {
  // Holding torques are the slope of the potential energy, so their path integral round a loop is zero and turning
  // gravity about changes only its sign. (Energies are checked against mass matrices where the arm has them.)
  for (int n = 0; n < 20; ++n) {
    JointVector a = random_.next(), tau, opposite;
    ASSERT_TRUE(arm_->gravity(a, kGravity, tau));
    ASSERT_TRUE(arm_->gravity(a, -kGravity, opposite));
    EXPECT_LT((tau + opposite).norm(), 1e-12);
    double round = 0, size = 0;
    constexpr int kSteps = 2000;
    const double radius = 0.04;
    for (int step = 0; step < kSteps; ++step) {  // the trapezoid rule is exact to rounding on a smooth loop
      const double phase = 2 * M_PI * step / kSteps;
      JointVector q = a, rate = JointVector::Zero(a.size());
      q[0] += radius * std::cos(phase), rate[0] = -radius * std::sin(phase);
      q[1] += radius * std::sin(phase), rate[1] = radius * std::cos(phase);
      q[2] += 0.5 * radius * std::sin(2 * phase), rate[2] = radius * std::cos(2 * phase);
      if (!arm_->gravity(q, kGravity, tau)) break;
      round += tau.dot(rate);
      size += std::abs(tau.dot(rate));
    }
    EXPECT_LT(std::abs(round), 1e-9 * std::max(size, 1e-3)) << a.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Kinematics, EveryArm, testing::ValuesIn(kArms),
                         [](const auto& one) { return std::string(one.param.name); });

TEST(Phantom, HasItsPublishedTipAndFrame) {
  const Phantom arm;
  Pose tip;
  arm.forward(arm.neutral(), tip);
  EXPECT_LT(tip.position.norm(), 1e-16);
  const Eigen::Vector3d q(0.3, -0.2, 0.4);
  arm.forward(q, tip);
  // x, y, z as published, in metres from the shoulder
  const double r = 0.215 * std::cos(-0.2) + 0.170 * std::sin(0.4), h = 0.215 * std::sin(-0.2) - 0.170 * std::cos(0.4);
  EXPECT_NEAR(tip.position.z() + 0.215, std::cos(0.3) * r, 1e-15);  // toward the user
  EXPECT_NEAR(tip.position.x(), std::sin(0.3) * r, 1e-15);          // to the right
  EXPECT_NEAR(tip.position.y() - 0.170, h, 1e-15);                  // up
}

TEST(Phantom, GivesBackTheVeryJointsItHad) {
  const Phantom arm;
  RandomJoints random(arm, 0.01);
  for (int n = 0; n < 2000; ++n) {
    const JointVector q = random.next();
    Pose tip;
    arm.forward(q, tip);
    JointVector found = q + Eigen::Vector3d(0.1, -0.1, 0.1);
    ASSERT_TRUE(arm.inverse(tip.position, found));
    if (std::abs(tip.position.x()) + std::abs(tip.position.z() + 0.215) < 1e-3) continue;  // on the vertical axis
    EXPECT_LT((found - q).norm(), 1e-11) << q.transpose();
  }
}

TEST(Phantom, RefusesLinksThatWouldCollide) {
  const Phantom arm;
  EXPECT_TRUE(arm.allowed(Eigen::Vector3d(0, 0, 0)));
  EXPECT_FALSE(arm.allowed(Eigen::Vector3d(0, 0, 1.0)));     // q3 - q2 above 55 degrees
  EXPECT_FALSE(arm.allowed(Eigen::Vector3d(0, 0.8, -0.4)));  // q2 - q3 above 65 degrees
}

TEST(Phantom, CarriesItsPublishedWeight) {
  const Phantom arm;
  const double g = 9.81, q2 = 0.3, q3 = 0.5;
  JointVector tau;
  arm.gravity(Eigen::Vector3d(0.7, q2, q3), Eigen::Vector3d(0, -g, 0), tau);
  const double l1 = .215, l2 = .17, l3 = .0325, l5 = -.0368, l6 = .0527;
  EXPECT_NEAR(tau[0], 0, 1e-15);
  EXPECT_NEAR(tau[1], 0.5 * g * (2 * l1 * .0202 + 2 * l5 * .2359 + l1 * .0249) * std::cos(q2), 1e-14);
  EXPECT_NEAR(tau[2], 0.5 * g * (l2 * .0202 + 2 * l3 * .0249 - 2 * l6 * .1906) * std::sin(q3), 1e-14);
}

TEST(Delta, IsSymmetricAboutItsAxis) {
  const Delta arm;
  Pose a, b;
  ASSERT_TRUE(arm.forward(Eigen::Vector3d(0.4, 0.6, 0.8), a));
  ASSERT_TRUE(arm.forward(Eigen::Vector3d(0.8, 0.4, 0.6), b));
  // The arms stand at equal angles (-120 degrees apart): passing the angles on turns the tip.
  const Eigen::Vector3d turned = Eigen::AngleAxisd(-2 * M_PI / 3, Eigen::Vector3d::UnitZ()) * a.position;
  EXPECT_LT((turned - b.position).norm(), 1e-13);
}

TEST(Chain, KeepsRightAnglesExact) {
  ChainGeometry geometry;
  geometry.links.resize(1);
  geometry.links[0].alpha = M_PI / 2;
  const Chain chain(geometry);
  ChainFrames at;
  chain.frames(JointVector::Zero(1), at);
  EXPECT_EQ(at.R[1](1, 1), 0);
  EXPECT_EQ(at.R[1](2, 1), 1);
}

TEST(Chain, RefusesNonsense) {
  ChainGeometry none;
  EXPECT_THROW(Chain{none}, std::invalid_argument);
  ChainGeometry many;
  many.links.resize(kMaxJoints + 1);
  EXPECT_THROW(Chain{many}, std::invalid_argument);
  ChainGeometry infinite = exampleChain();
  infinite.links[3].d = HUGE_VAL;
  EXPECT_THROW(Chain{infinite}, std::invalid_argument);
  ChainGeometry swapped = exampleChain();
  std::swap(swapped.links[2].min, swapped.links[2].max);
  EXPECT_THROW(Chain{swapped}, std::invalid_argument);
}

}  // namespace
}  // namespace hapticd::kinematics
