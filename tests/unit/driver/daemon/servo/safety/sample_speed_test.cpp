// SPDX-License-Identifier: MIT
#include "servo/safety/sample_speed.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

TEST(SampleSpeed, IsTheWayOverTheTimeBetweenTwoStamps) {
  SampleSpeed speed(1000, 0);
  EXPECT_EQ(speed.update({5, 0, 0}, 1'000'000, 1), 0) << "one sample has no speed";
  EXPECT_NEAR(speed.update({5, 0.003, 0.004}, 3'000'000, 2e-3), 2.5, 1e-9);
}

TEST(SampleSpeed, OfAnArmThatNamesNoRateTakesTwoMillisecondsAtLeast) {
  SampleSpeed speed(0, 0);
  speed.update({0, 0, 0}, 1'000'000, 1);
  EXPECT_NEAR(speed.update({0.01, 0, 0}, 1'100'000, 1e-4), 5, 1e-9);
}

/// Measured each ms, delivered two at a time and stamped as they come: nobody moved twice as fast.
TEST(SampleSpeed, OfPairsIsThatOfTheHand) {
  SampleSpeed speed(1000, 0);
  double most = 0;
  for (uint64_t pair = 0; pair < 100; ++pair)
    for (uint64_t i = 0; i < 2; ++i) {
      const double y = 3.0 * static_cast<double>(2 * pair + i) * 1e-3;
      most = std::max(most, speed.update({0, y, 0}, pair * 2'000'000 + i * 1000 + 1, i == 0 ? 1.999e-3 : 1e-6));
    }
  EXPECT_LE(most, 3.0 * (1 + 1e-9));
}

TEST(SampleSpeed, OfStampsThatWereMeasuredFartherApartThanTheyCameIsNoJump) {
  SampleSpeed speed(1000, 0);
  speed.update({0, 0, 0}, 1'000'000, 1);
  EXPECT_NEAR(speed.update({0.006, 0, 0}, 3'000'000, 0.5e-3), 3, 1e-9);
}

/// A clock that runs away, or goes backward, makes no jump slow.
TEST(SampleSpeed, BelievesNoClockThatSaysMuchMoreThanPassed) {
  SampleSpeed speed(1000, 0);
  speed.update({0, 0, 0}, 1'000'000, 1);
  EXPECT_NEAR(speed.update({0.039, 0, 0}, 10'000'000'000, 1e-4), 0.039 / (1e-4 + SampleSpeed::kAhead), 1e-9);
  EXPECT_NEAR(speed.update({0, 0, 0}, 5, 1e-3), 39, 1e-9) << "backward: the host's time";
  EXPECT_NEAR(speed.update({0.039, 0, 0}, 0, 3e-3), 13, 1e-9) << "without stamps too";
}

TEST(SampleSpeed, TakesOneStepOfAnEncoderForRest) {
  SampleSpeed speed(1000, 3e-5);
  speed.update({0, 0, 0}, 1, 1);
  EXPECT_EQ(speed.update({2.9e-5, 0, 0}, 2, 1e-3), 0);
  EXPECT_NEAR(speed.update({2.9e-5, 0, 1e-3}, 3, 1e-3), 0.97, 1e-9);
}

TEST(SampleSpeed, AssumesAPeriodWhereTheArmSaysNone) {
  SampleSpeed speed(0, 0);
  speed.update({0, 0, 0}, 1, 1);
  EXPECT_NEAR(speed.update({0.01, 0, 0}, 2, 1e-9), 0.01 / SampleSpeed::kAssumedPeriod, 1e-9);
}

TEST(SampleSpeed, StartsAnewAfterAGap) {
  SampleSpeed speed(1000, 0);
  speed.update({0, 0, 0}, 1, 1);
  speed.reset();
  EXPECT_EQ(speed.update({1, 0, 0}, 2, 1e-3), 0);
}

TEST(SampleSpeed, TakesTheHostsTimeWhereStampsStandStill) {
  SampleSpeed unstamped(1000, 0);
  unstamped.update({0, 0, 0}, 0, 1);
  EXPECT_NEAR(unstamped.update({0.004, 0, 0}, 0, 4e-3), 1, 1e-9);
}

TEST(SampleSpeed, BelievesAnArmThatIsSlow) {
  SampleSpeed slow(0.5, 0);
  slow.update({0, 0, 0}, 0, 1);
  EXPECT_NEAR(slow.update({1, 0, 0}, 0, 1e-3), 0.5, 1e-9);
}

}  // namespace
}  // namespace hapticd::servo
