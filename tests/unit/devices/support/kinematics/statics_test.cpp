// SPDX-License-Identifier: MIT
#include "kinematics/statics.hpp"

#include <gtest/gtest.h>

#include "kinematics/phantom.hpp"

namespace hapticd::kinematics {
namespace {

Jacobian random6(int joints, unsigned seed) {
  std::srand(seed);
  return Jacobian::Random(6, joints);
}

TEST(Statics, PseudoInverseGivesTheSmallestWrenchWhereRankIsMissing) {
  for (unsigned seed = 1; seed < 50; ++seed) {
    Jacobian J = random6(8, seed);
    J.row(4) = 2 * J.row(1) - J.row(0);  // rank 5
    const Wrench W = Wrench::Random();
    PseudoInverseOptions how;
    how.length = 1;
    const WrenchEstimate found = wrenchFromTorques(J, jointTorques(J, W), how);
    EXPECT_EQ(found.rank, 5);
    EXPECT_LT(found.residual, 1e-12);
    EXPECT_LE(found.W.norm(), W.norm() * (1 + 1e-12));
  }
}

TEST(Statics, PseudoInverseFitsTorquesThatNoWrenchExplains) {
  const Jacobian J = random6(8, 3);
  const JointVector tau = JointVector::Random(8);
  const WrenchEstimate found = wrenchFromTorques(J, tau);
  EXPECT_GT(found.residual, 0.01);
  // The residual is orthogonal to everything a wrench can do: least squares.
  EXPECT_LT((J * (jointTorques(J, found.W) - tau)).norm(), 1e-12);
}

TEST(Statics, PseudoInverseKeepsSmallSingularValues) {
  Jacobian J = Jacobian::Zero(6, 6);
  for (int i = 0; i < 6; ++i) J(i, i) = std::pow(10, -i);
  const Wrench W = Wrench::Ones();
  const WrenchEstimate found = wrenchFromTorques(J, jointTorques(J, W));
  EXPECT_EQ(found.rank, 6);
  EXPECT_LT((found.W - W).norm(), 1e-12);
}

TEST(Statics, DampingBoundsTheEstimateNearASingularPose) {
  Jacobian J = Jacobian::Zero(6, 3);
  J(0, 0) = 1, J(1, 1) = 1;
  const JointVector noise = Eigen::Vector3d(0, 0, 0.01);
  PseudoInverseOptions damped;
  damped.damping = 0.05;
  for (double s = 0.1; s > 1e-12; s *= 0.5) {
    J(2, 2) = s;
    EXPECT_LE(wrenchFromTorques(J, noise, damped).W.norm(), 0.01 / 0.05 * 1.0001);
  }
  J(2, 2) = 0.06;  // above the threshold nothing changes
  EXPECT_NEAR(wrenchFromTorques(J, noise, damped).W[2], 0.01 / 0.06, 1e-12);
}

TEST(Statics, ZeroAndNonsenseGiveZeroRank) {
  EXPECT_EQ(wrenchFromTorques(Jacobian::Zero(6, 3), JointVector::Ones(3)).rank, 0);
  EXPECT_EQ(wrenchFromTorques(Jacobian::Constant(6, 3, std::nan("")), JointVector::Ones(3)).W, Wrench::Zero());
}

TEST(Statics, ConditioningFindsTheStretchedArmSingular) {
  const Phantom arm;
  Jacobian J;
  arm.jacobian(arm.neutral(), J);
  EXPECT_GT(conditioning(J, 0.1, true).inverse_condition, 0.5);
  arm.jacobian(Eigen::Vector3d(0, 0, M_PI / 2), J);  // forearm in line with the upper arm
  EXPECT_LT(conditioning(J, 0.1, true).inverse_condition, 1e-15);
  EXPECT_EQ(conditioning(J, 0.1, true).rank, 2);
}

}  // namespace
}  // namespace hapticd::kinematics
