// SPDX-License-Identifier: MIT
#include "servo/safety/power_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;
const Vector3d kAlong = Vector3d::UnitX();

TEST(PowerBound, IsPowerOverSpeedWhereNothingLagsAndNothingAccelerates) {
  PowerBound bound;
  EXPECT_EQ(bound.most(kAlong, 1), HUGE_VAL) << "at rest";
  bound.watch({0.5, 3, 0});
  bound.pass(1e-3);
  EXPECT_NEAR(bound.most(kAlong, 1), 2, 1e-12);
  EXPECT_EQ(bound.most(-kAlong, 1), HUGE_VAL) << "what the hand does is its own";
}

TEST(PowerBound, ReckonsWithHalfAsMuchAgainAsWasSeen) {
  PowerBound bound;
  bound.expect(2e-3, 0);
  bound.watch(Vector3d::Zero());
  bound.pass(1e-3);
  bound.watch({0.01, 0, 0});  // 10 m/s^2, for 3 ms
  EXPECT_NEAR(1 / bound.most(kAlong, 1), 0.01 + 1.5 * 10 * 3e-3, 1e-9);
}

TEST(PowerBound, TakesTheFirstEstimateForNoAcceleration) {
  PowerBound bound;
  bound.expect(2e-3, 0);
  bound.pass(1e-3);
  bound.watch({0.5, 0, 0});  // after a pause, the hand in full motion
  EXPECT_NEAR(bound.most(kAlong, 1), 2, 1e-12);
}

TEST(PowerBound, ReckonsWithTheLagAndTheAccelerationsOfLate) {
  PowerBound bound;
  bound.expect(2e-3, 0);
  bound.watch(Vector3d::Zero());
  bound.pass(1e-3);
  bound.watch({0.01, 0, 0});  // 10 m/s^2
  EXPECT_NEAR(1 / bound.most(kAlong, 1), 0.01 + PowerBound::kMargin * 10 * 3e-3, 1e-9) << "lag and a tick";
  bound.pass(1e-3);
  const double later = 10 * (1 - 1e-3 / 0.02);  // they are forgotten in 20 ms
  EXPECT_NEAR(1 / bound.most(kAlong, 1), 0.01 + PowerBound::kMargin * later * 4e-3, 1e-9) << "and its age";
  for (int i = 0; i < 1000; ++i) {
    bound.watch({0.01, 0, 0});
    bound.pass(1e-3);
  }
  EXPECT_NEAR(1 / bound.most(kAlong, 1), 0.01, 1e-6) << "and forgets";
  bound.pass(1);
  EXPECT_LE(bound.most(kAlong, 1), 100 * (1 + 1e-6));
}

TEST(PowerBound, ReckonsWithWhatTheForceDoesToALightArm) {
  PowerBound bound;
  bound.expect(1e-3, 0.05);
  bound.watch({0.2, 0, 0});
  bound.pass(1e-3);
  const double ahead = 3e-3, force = bound.most(kAlong, 0.3);
  EXPECT_NEAR(force * (0.2 + force * ahead / 0.05), 0.3, 1e-9);
  const double against = bound.most(-kAlong, 0.3);
  EXPECT_NEAR(against * (-0.2 + against * ahead / 0.05), 0.3, 1e-9);
  EXPECT_GT(against, force);
}

TEST(PowerBound, OfTwoEstimatesAtOnceMakesNoAcceleration) {
  PowerBound bound;
  bound.watch(Vector3d::Zero());
  bound.watch({0.5, 0, 0});
  bound.pass(1e-3);
  EXPECT_NEAR(bound.most(kAlong, 1), 2, 1e-12);
}

TEST(PowerBound, LagsNotAndWeighsNothingUntilItIsTold) {
  PowerBound bound;
  bound.watch(Vector3d::Zero());
  bound.pass(1e-3);
  bound.watch({0.01, 0, 0});
  EXPECT_NEAR(1 / bound.most(kAlong, 1), 0.01 + PowerBound::kMargin * 10 * 1e-3, 1e-9);
}

TEST(PowerBound, ReckonsWithTheTimeThatPassedAlone) {
  const auto from_rest = [](double ahead) { return std::sqrt(0.3 * 0.05 / ahead); };  // F * F t / m = P
  PowerBound told;
  told.expect(1e-3, 0.05);
  told.watch(Vector3d::Zero());
  EXPECT_NEAR(told.most(kAlong, 0.3), from_rest(1e-3), 1e-9) << "before the first tick";
  PowerBound silent;
  silent.expect(0, 0.05);
  silent.pass(1e-3);
  EXPECT_NEAR(silent.most(kAlong, 0.3), from_rest(2e-3), 1e-9) << "without an estimate";
}

}  // namespace
}  // namespace hapticd::servo
