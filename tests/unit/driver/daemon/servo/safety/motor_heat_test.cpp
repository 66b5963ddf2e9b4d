// SPDX-License-Identifier: MIT
#include "servo/safety/motor_heat.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::servo {
namespace {

/// Maxon RE25 118743, the PHANToM Premium 1.5's motor; the numbers of its data sheet.
scene::Motor re25() {
  return {1, 0.0234, 2.18, 3.1, 14, 12, 612, 100, 25};
}
constexpr double kContinuous = 0.0286;  ///< [N m] the data sheet's continuous torque
constexpr double kStall = 0.129;        ///< [N m]

double secondsUntilSpared(double torque) {
  MotorHeat heat({re25()});
  double t = 0;
  for (; t < 10000 && heat.factor() == 1; t += 0.01) heat.heat(&torque, 0.01);
  return t;
}

TEST(MotorHeat, TheContinuousTorqueOfTheDataSheetEndsNearItsHottestWinding) {
  scene::Motor motor = re25();
  motor.max_temperature = 400;
  MotorHeat heat({motor});
  for (int i = 0; i < 500000; ++i) heat.heat(&kContinuous, 0.01);
  EXPECT_NEAR(heat.hottest(), 100, 5);
}

TEST(MotorHeat, StallTorqueIsLentForSecondsAndPartOfTheContinuousOneForEver) {
  EXPECT_GT(secondsUntilSpared(kStall), 0.5);
  EXPECT_LT(secondsUntilSpared(kStall), 6);
  EXPECT_GT(secondsUntilSpared(2 * kContinuous), secondsUntilSpared(3 * kContinuous));
  EXPECT_GE(secondsUntilSpared(0.8 * kContinuous), 10000);
}

TEST(MotorHeat, ForcesThatFollowTheFactorNeverOverheatAMotor) {
  MotorHeat heat({re25(), re25(), re25()});
  for (int i = 0; i < 300000; ++i) {
    const double torque[3] = {kStall * heat.factor(), -kStall * heat.factor(), 0};
    heat.heat(torque, 0.01);
    ASSERT_FALSE(heat.overheated());
    ASSERT_LE(heat.hottest(), 100);
  }
  EXPECT_LT(heat.factor(), 1);
}

TEST(MotorHeat, CoolsToTheAirAndForgets) {
  MotorHeat heat({re25()});
  for (int i = 0; i < 100; ++i) heat.heat(&kStall, 0.01);
  const double none = 0;
  for (int i = 0; i < 1000000; ++i) heat.heat(&none, 0.01);
  EXPECT_NEAR(heat.hottest(), 25, 0.1);
  EXPECT_EQ(heat.factor(), 1);
}

TEST(MotorHeat, ATorqueThatIsNotANumberDoesNotSpoilTheModel) {
  MotorHeat heat({re25()});
  const double bad = std::nan("");
  heat.heat(&bad, 0.01);
  EXPECT_EQ(heat.hottest(), 25);
}

}  // namespace
}  // namespace hapticd::servo
