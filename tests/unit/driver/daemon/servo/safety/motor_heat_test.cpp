// SPDX-License-Identifier: MIT
#include "servo/safety/motor_heat.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

/// The bounds that safety.md names: sparing from 10 K below the limit, a fault 5 K beyond it.
TEST(MotorHeat, SparesFromTenKelvinBelowItsLimitAndIsAFaultFiveBeyond) {
  MotorHeat heat({re25()});
  EXPECT_FALSE(heat.overheated());
  bool spared = false, hot = false;
  for (int i = 0; i < 100000 && !hot; ++i) {
    heat.heat(&kStall, 1e-3);
    const double room = 100 - heat.hottest();
    ASSERT_NEAR(heat.factor(), std::clamp(room / 10, 0.0, 1.0), 1e-12);
    ASSERT_EQ(heat.overheated(), room < -5) << room;
    spared = spared || (heat.factor() > 0 && heat.factor() < 1);
    hot = heat.overheated();
  }
  EXPECT_TRUE(spared && hot);
}

TEST(MotorHeat, IsNoFaultAtFiveKelvinBeyondItsLimitButAboveThem) {
  for (const double ambient : {105.0, 105.001}) {
    scene::Motor motor = re25();
    motor.ambient = ambient;
    motor.max_temperature = 100;
    MotorHeat heat({motor});
    const double none = 0;
    heat.heat(&none, 0);
    EXPECT_EQ(heat.overheated(), ambient > 105) << ambient;
  }
}

TEST(MotorHeat, WatchesEveryMotor) {
  for (size_t hot = 0; hot < 3; ++hot) {
    MotorHeat heat({re25(), re25(), re25()});
    double torque[3] = {0, 0, 0};
    torque[hot] = kStall;
    for (int i = 0; i < 10000; ++i) heat.heat(torque, 0.01);
    EXPECT_TRUE(heat.overheated()) << hot;
    EXPECT_EQ(heat.factor(), 0) << hot;
    EXPECT_EQ(heat.hottest(), heat.winding(hot)) << hot;
  }
}

TEST(MotorHeat, TakesALongGapForATenthOfASecond) {
  MotorHeat gap({re25()}), tenth({re25()});
  gap.heat(&kStall, 5);
  tenth.heat(&kStall, 0.1);
  EXPECT_EQ(gap.winding(0), tenth.winding(0));
  EXPECT_GT(tenth.winding(0), 25);
}

TEST(MotorHeat, NamesTheFirstOfTwoThatAreEquallyNearTheirLimits) {
  scene::Motor warm = re25();
  warm.ambient = 35;
  warm.max_temperature = 110;
  MotorHeat heat({re25(), warm});
  const double none[2] = {0, 0};
  heat.heat(none, 0.01);
  EXPECT_EQ(heat.hottest(), 25);
}

TEST(MotorHeat, IsEmptyWithoutMotors) {
  EXPECT_TRUE(MotorHeat({}).empty());
  EXPECT_FALSE(MotorHeat({re25()}).empty());
  EXPECT_EQ(MotorHeat({re25(), re25()}).count(), 2u);
}

}  // namespace
}  // namespace hapticd::servo
