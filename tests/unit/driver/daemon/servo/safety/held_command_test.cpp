// SPDX-License-Identifier: MIT
#include "servo/safety/held_command.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::servo {
namespace {

constexpr double kFreeMass = 0.059;  // [kg] of the tip of a simulated Premium 1.5, where it is lightest

TEST(HeldCommand, IsHeldUntilTheNextTickOrTwoSamplesOfASlowArm) {
  EXPECT_DOUBLE_EQ(longestHeld(1000, 1000), 0.002);
  EXPECT_DOUBLE_EQ(longestHeld(100, 1000), 0.01);
  EXPECT_DOUBLE_EQ(longestHeld(1000, 100), 0.02);
  EXPECT_DOUBLE_EQ(longestHeld(1000, 0), 0.001) << "an arm that names no rate";
  EXPECT_DOUBLE_EQ(longestHeld(1000, 1), 2) << "any rate that is known counts";
}

TEST(HeldCommand, HasTheFullForceWhereItIsFastEnough) {
  EXPECT_EQ(shareHeld(0.0028), 1);
  EXPECT_EQ(mostForceAt(358, 1000, 8.5), HUGE_VAL);
  EXPECT_EQ(mostForceAt(1000, 715, 8.5), HUGE_VAL);
  EXPECT_LT(mostForceAt(357, 1000, 8.5), 8.5);
  EXPECT_LT(mostForceAt(1000, 714, 8.5), 8.5);
}

/// Whatever the period: a share of 8.5 N, held for it, gives a free tip at most 5 mJ and moves it by at most 1 mm.
TEST(HeldCommand, GivesAFreeTipLittleHoweverLongItIsHeld) {
  double before = 1;
  for (double held = 0.001; held < 1; held *= 1.01) {
    const double force = shareHeld(held) * kReckonedForce, impulse = force * held;
    EXPECT_LE(impulse * impulse / (2 * kFreeMass), 5e-3) << held;
    EXPECT_LE(impulse * held / (2 * kFreeMass), 1e-3) << held;
    EXPECT_LE(shareHeld(held), before);
    EXPECT_GT(shareHeld(held), 0.97 * before) << "no step at " << held;
    before = shareHeld(held);
  }
  EXPECT_NEAR(shareHeld(0.004), 0.7, 1e-12);
  EXPECT_NEAR(shareHeld(0.01), 0.1296, 1e-12);
}

TEST(HeldCommand, TakesAStrongArmForAHeavyOneAndAWeakOneAsItIs) {
  EXPECT_NEAR(mostForceAt(100, 1000, 90), 11.664, 1e-9);
  EXPECT_NEAR(mostForceAt(100, 1000, 8.5), 1.1016, 1e-9);
  EXPECT_NEAR(mostForceAt(100, 1000, 3.3), 1.1016, 1e-9);
  EXPECT_NEAR(mostForceAt(100, 1000, 0), 1.1016, 1e-9) << "a maximum that nobody knows";
}

TEST(HeldCommand, TellsWhyAnArmPushesLessAndTheCure) {
  EXPECT_EQ(describeSlow(1000, 1000, 8.5, 8.5), "");
  EXPECT_EQ(describeSlow(100, 1000, 8.5, 1.1), "") << "that little it has all the same";
  EXPECT_EQ(describeSlow(100, 1000, 8.5, 8.5),
            "the servo's rate is low: after a fault the motors may keep the last command for 10 ms, so the force is "
            "limited to 1.1 N "
            "instead of 8.5 N, which moves a free arm by at most 1 mm and gives it at most 5 mJ; expected at least 358 "
            "Hz for the full force");
  EXPECT_EQ(
      describeSlow(1000, 500, 0, 0),
      "its own rate is low: after a fault the motors may keep the last command for 4 ms, so the force is limited to "
      "5.95 N, "
      "which moves a free arm by at most 1 mm and gives it at most 5 mJ; expected at least 715 Hz for the full force");
  EXPECT_NE(describeSlow(100, 100, 0, 0)
                .find("its own rate is low: after a fault the motors may keep the last command for 20 ms"),
            std::string::npos);
  EXPECT_EQ(describeSlow(100, 1000, 8.5, 0.5), "");
  EXPECT_NE(describeSlow(100, 0, 0, 0).find("the servo's rate"), std::string::npos) << "an arm that names none";
  EXPECT_NE(describeSlow(1000, 0.5, 0, 0).find("its own rate"), std::string::npos);
  EXPECT_NE(describeSlow(100, 200, 0, 0).find("the servo's rate"), std::string::npos) << "both are as slow";
}

}  // namespace
}  // namespace hapticd::servo
