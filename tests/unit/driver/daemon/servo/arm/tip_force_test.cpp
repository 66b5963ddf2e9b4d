// SPDX-License-Identifier: MIT
#include "servo/arm/tip_force.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

TipJacobian randomJacobian(int joints, std::mt19937& random) {
  TipJacobian J(3, joints);
  for (int i = 0; i < joints; ++i)
    for (int row = 0; row < 3; ++row) J(row, i) = std::uniform_real_distribution<double>(-0.5, 0.5)(random);
  return J;
}

TEST(TipForce, IsTheForceThatTheTorquesCameFrom) {
  std::mt19937 random(5);
  for (const int joints : {3, 6, 8, 16})
    for (int i = 0; i < 200; ++i) {
      const TipJacobian J = randomJacobian(joints, random);
      const TipInverse inverse(J);
      const Vector3d force = Vector3d::Random() * 10;
      const JointVector torque = J.transpose() * force;
      if (inverse.health() == 1) {
        EXPECT_LT((inverse.force(torque) - force).norm(), 1e-9);
        EXPECT_LT((J * inverse.rates(force) - force).norm(), 1e-9);
      }
    }
}

TEST(TipForce, StaysBoundedAndSilentAlongADirectionThatTheArmLoses) {
  // A stretched planar arm: no joint moves the tip along x. Torques that no tip force explains must not become one.
  for (const double bend : {1e-2, 1e-4, 1e-8, 0.0}) {
    TipJacobian J = TipJacobian::Zero(3, 3);
    J << bend, bend, 0, 0.6, 0.3, 0, 0, 0, 0.6;
    const TipInverse inverse(J);
    EXPECT_LT(inverse.health(), 1);
    for (const double noise : {0.02, -0.02}) {
      const JointVector torque = noise * Vector3d(1, -1, 1);
      const Vector3d force = inverse.force(torque);
      EXPECT_TRUE(force.allFinite());
      EXPECT_LT(force.norm(), 0.02 * 3 / (TipInverse::kDamped * 0.6)) << "at most the damped gain";
      EXPECT_LT(inverse.rates(Vector3d(0.1, 0, 0)).norm(), 0.1 / (TipInverse::kDamped * 0.6));
    }
    if (bend <= 1e-8) {
      const JointVector torque = Vector3d(1, -1, 0);
      EXPECT_LT(std::abs(inverse.force(torque).x()), 1e-4);
    }
    const Vector3d across(0, 3, -2);  // what the arm can feel, it feels in full
    const JointVector torque = J.transpose() * across;
    EXPECT_LT((inverse.force(torque) - across).norm(), 0.02 * across.norm());
  }
}

TEST(TipForce, AnswersNonsenseWithZero) {
  TipJacobian J = TipJacobian::Constant(3, 4, std::nan(""));
  EXPECT_EQ(TipInverse(J).health(), 0);
  J.setZero();
  EXPECT_EQ(TipInverse(J).force(JointVector::Ones(4)), Vector3d::Zero());
}

}  // namespace
}  // namespace hapticd::servo
