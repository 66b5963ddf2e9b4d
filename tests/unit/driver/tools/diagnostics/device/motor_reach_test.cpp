// SPDX-License-Identifier: MIT
#include "diagnostics/device/motor_reach.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hapticd::diagnostics {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

TEST(MotorReach, OfAnArmWithoutCouplingIsTheCornerOfABox) {
  Matrix3Xd jacobian = Vector3d(0.1, 0.2, 0.5).asDiagonal();
  EXPECT_NEAR(*farthestReach(jacobian, {1, 1, 1}), Vector3d(10, 5, 2).norm(), 1e-12);
}

TEST(MotorReach, IsReachedAndNeverPassed) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 300; ++round) {
    const int joints = 3 + static_cast<int>(random() % 4);
    Matrix3Xd jacobian(3, joints);
    for (double& value : jacobian.reshaped()) value = normal(random);
    std::vector<double> torque;
    for (int i = 0; i < joints; ++i) torque.push_back(0.1 + std::abs(normal(random)));
    const auto reach = farthestReach(jacobian, torque);
    if (!reach) continue;
    const auto lengthAlong = [&](const Vector3d& way) {
      double length = 1e300;
      for (int j = 0; j < joints; ++j)
        length =
            std::min(length, torque[static_cast<size_t>(j)] / std::max(1e-300, std::abs(jacobian.col(j).dot(way))));
      return length;
    };
    const auto anyWay = [&] { return Vector3d(normal(random), normal(random), normal(random)).normalized(); };
    Vector3d best = anyWay();
    for (int i = 0; i < 6000; ++i) {  // anywhere first, then nearer and nearer to the best
      const double near = i < 1000 ? 1e3 : 2.0 * std::pow(1e-4, (i - 1000) / 5000.0);
      const Vector3d way = (best + near * anyWay()).normalized();
      if (lengthAlong(way) > lengthAlong(best)) best = way;
    }
    const double most = lengthAlong(best);
    ASSERT_LE(most, *reach * (1 + 1e-9)) << round;
    ASSERT_GT(most, 0.9 * *reach) << round;
  }
}

TEST(MotorReach, KnowsNoBoundWhereTheJointsCarry) {
  Matrix3Xd flat = Matrix3Xd::Zero(3, 3);
  flat.col(0) = Vector3d(1, 0, 0), flat.col(1) = Vector3d(0, 1, 0), flat.col(2) = Vector3d(1, 1, 0);
  EXPECT_FALSE(farthestReach(flat, {1, 1, 1}));
  EXPECT_FALSE(farthestReach(flat.leftCols(2), {1, 1}));
  EXPECT_FALSE(farthestReach(Matrix3Xd::Identity(3, 3), {1, 1}));
}

}  // namespace
}  // namespace hapticd::diagnostics
