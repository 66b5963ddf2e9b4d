// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "limiter_rig.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

TEST(Limiter, RampsInFromZero) {
  scene::Limits limits;
  limits.slew = 0;
  limits.ramp_in = 0.1;
  Limiter limiter(limits, 8.5);
  double last = 0;
  for (int i = 0; i < 100; ++i) {
    const double force = limited(limiter, {4, 0, 0}).x();
    EXPECT_LE(force - last, 4.0 / 100 + 1e-12);
    last = force;
  }
  EXPECT_NEAR(last, 4, 1e-9);
}

TEST(Limiter, RampsItsLimitsToo) {
  scene::Limits limits;
  limits.slew = 0;
  limits.torque = 0.5;
  limits.ramp_in = 0.25;
  Limiter limiter(limits, 8.5);
  double share = 0;
  for (int i = 1; i <= 300; ++i) {  // a tip 30 m inside a model asks for 24 kN from the first tick on
    Vector3d force(24000, 0, 0), torque(0, 1000, 0);
    limiter.apply(force, torque, Vector3d::Zero(), 1e-3);
    share = std::min(1.0, i / 250.0);
    EXPECT_NEAR(force.x(), 8.5 * share, 1e-9) << i;
    EXPECT_NEAR(torque.y(), 0.5 * share, 1e-9) << i;
  }
  EXPECT_EQ(share, 1);
}

TEST(Limiter, KeepsTheDirectionWhenItCutsTheForce) {
  Limiter limiter(generous(), 8.5);
  const Vector3d force = limited(limiter, {30, 40, 0});
  EXPECT_NEAR(force.norm(), 8.5, 1e-12);
  EXPECT_NEAR(force.y() / force.x(), 4.0 / 3.0, 1e-12);
}

TEST(Limiter, TheDeviceMaximumHoldsWhateverTheFileAllows) {
  scene::Limits limits = generous();
  limits.force = 100;
  Limiter limiter(limits, 8.5);
  EXPECT_NEAR(limited(limiter, {50, 0, 0}).norm(), 8.5, 1e-12);
}

TEST(Limiter, NeverGrowsOrTurnsFasterThanTheSlewLimitAndNeverHoldsAForceThatIsGone) {
  scene::Limits limits = generous();
  limits.slew = 500;
  Limiter limiter(limits, 0);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-10, 10);
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < 10000; ++i) {
    const Vector3d asked = i % 7 == 0 ? Vector3d::Zero() : Vector3d(any(random), any(random), any(random));
    const Vector3d force = limited(limiter, asked);
    EXPECT_LE(force.norm(), asked.norm() * (1 + 1e-12));
    EXPECT_LE(force.norm(), last.norm() + 0.5 + 1e-12);
    if (force.norm() < asked.norm() * (1 - 1e-12)) {
      EXPECT_LE((force - last).norm(), 0.5 + 1e-12);
    }
    last = force;
  }
}

TEST(Limiter, TheSlewLimitIsTheSameAtEveryRate) {
  scene::Limits limits = generous();
  limits.slew = 2000;
  for (const double rate : {1000.0, 5000.0, 10000.0, 20000.0}) {
    Limiter contact(limits, 0);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> noise(-0.4, 0.4);  // steps of an encoder times stiffness and damping
    for (int i = 0; i < 2000; ++i) {
      const double asked = 3 * std::sin(i / rate * 20) + noise(random);
      EXPECT_EQ(limited(contact, {asked, 1, 0}, 1 / rate).x(), asked) << rate << " Hz";
    }
    Limiter kick(limits, 0);
    double t = 0, last = 0;
    for (; t < 0.1 && last < 8; t += 1 / rate) {
      const double force = limited(kick, {8, 0, 0}, 1 / rate).x();
      EXPECT_LE(force, limits.slew * (t + Limiter::kSlewWindow) + 1e-9) << rate << " Hz";
      last = force;
    }
    EXPECT_NEAR(t, 8 / limits.slew, 1.001e-3) << rate << " Hz";
  }
}

/// What follows the force stays behind it also by parts of a newton.
TEST(Limiter, AForceGrowsAfterAGapByNoMoreThanInOnePeriod) {
  for (const double period : {1e-4, 1e-3, 1e-2}) {
    scene::Limits limits = generous();
    limits.slew = 2000;
    Limiter limiter(limits, 0);
    limiter.expectPeriod(period);
    const double step = limits.slew * std::max(period, Limiter::kSlewWindow);
    EXPECT_LE(limited(limiter, {1e3, 0, 0}, 0.05).x(), step + 1e-9) << period;
    EXPECT_LE(limited(limiter, {1e3, 0, 0}, 0.09).x(), 2 * step + 1e-9) << period;
    EXPECT_EQ(limited(limiter, {0, 0, 0}, 0.09).x(), 0) << period;
  }
}

TEST(Limiter, ASmallSlewLimitHoldsAtAFastRate) {
  scene::Limits limits = generous();
  limits.slew = 500;
  Limiter kick(limits, 0);
  for (int i = 0; i < 200; ++i)
    ASSERT_LE(limited(kick, {8, 0, 0}, 5e-5).x(), limits.slew * (i * 5e-5 + Limiter::kSlewWindow) + 1e-9) << i;
}

/// Every limit at once, with random bounds.
scene::Limits anyLimits(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  scene::Limits limits;
  limits.force = unit(random) < 0.2 ? 0 : 10 * unit(random);
  limits.torque = unit(random) < 0.5 ? 0 : unit(random);
  limits.slew = unit(random) < 0.3 ? 0 : 3000 * unit(random);
  limits.torque_slew = unit(random) < 0.3 ? 0 : 100 * unit(random);
  limits.power = unit(random) < 0.5 ? 0 : 2 * unit(random);
  limits.impulse = unit(random) < 0.5 ? 0 : 0.5 * unit(random);
  limits.workspace = unit(random) < 0.5 ? 0 : 0.2 * unit(random);
  limits.ramp_in = 0.3 * unit(random);
  limits.ramp_out = 0.02 * unit(random);
  if (unit(random) < 0.3) limits.enable = {3, scene::EnableMode::kHold};
  return limits;
}

TEST(Limiter, NoLimitEverRaisesAForceOrTorqueWhateverComes) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&](double size) { return Vector3d(size * any(random), size * any(random), size * any(random)); };
  for (int run = 0; run < 300; ++run) {
    Limiter limiter(anyLimits(random), 8.5);
    for (int i = 0; i < 300; ++i) {
      limiter.watchVelocity(vector(2));
      limiter.watchButtons(any(random) > -0.9 ? 8 : 0);
      limiter.spareMotors(std::abs(any(random)));
      const Vector3d asked = vector(20), asked_torque = vector(2);
      Vector3d force = asked, torque = asked_torque;
      limiter.apply(force, torque, vector(0.3), 1e-4 + 2e-3 * std::abs(any(random)));
      ASSERT_LE(force.norm(), asked.norm() * (1 + 1e-12));
      ASSERT_LE(torque.norm(), asked_torque.norm() * (1 + 1e-12));
      ASSERT_LE(force.norm(), 8.5 + 1e-9);
    }
  }
}

TEST(Limiter, EveryFaultAtEveryRateEndsInZeroWithinTwentyMillisecondsAndNeverRaisesTheForce) {
  for (int fault = 1; fault < kFaultCount; ++fault)
    for (const double rate : {100.0, 333.0, 500.0, 997.0, 1000.0, 1500.0, 3000.0, 7777.0, 10000.0}) {
      scene::Limits limits = generous();
      Limiter limiter(limits, 8.5);
      limited(limiter, {5, -3, 1}, 1 / rate);
      limiter.trip(static_cast<Fault>(fault));
      double last = Vector3d(5, -3, 1).norm(), t = 0;
      for (; last > 0 && t < 1; t += 1 / rate) {
        const double force = limited(limiter, {8, 8, 8}, 1 / rate).norm();
        ASSERT_LE(force, last);
        last = force;
      }
      EXPECT_LE(t, 0.02 + 1 / rate + 1e-9) << rate << " Hz";  // the tick of the fault counts as one
      EXPECT_TRUE(limiter.silent());
    }
}

/// A sample that grows old is worth less and less; a new one brings the force back without a kick.
TEST(Limiter, AnOldSampleLetsTheForceFadeAndANewOneRampsIt) {
  Limiter limiter(generous(), 8.5);
  double last = limited(limiter, {4, 0, 0}).x();
  EXPECT_EQ(last, 4);
  for (const double trust : {1.0, 0.5, 0.0, 0.0}) {
    limiter.trustSample(trust);
    EXPECT_EQ(limited(limiter, {4, 0, 0}).x(), 4 * trust);
  }
  EXPECT_EQ(limiter.clips().ticks[static_cast<size_t>(Limit::kSample)], 3u);
  limiter.trustSample(1);
  last = 0;
  for (int i = 0; i < 20; ++i) {
    const double force = limited(limiter, {4, 0, 0}).x();
    EXPECT_LE(force - last, 4 * 0.001 / Limiter::kFreshRamp + 1e-12);
    last = force;
  }
  EXPECT_NEAR(last, 4, 1e-9);
}

/// Found by random schedules: positions that were no numbers in the middle of a planned ramp, then 3.8 N from nothing.
TEST(Limiter, ARampThatCouldNotBeSentIsNotTakenUpAgain) {
  Limiter limiter(generous(), 8.5);
  limited(limiter, {8, 0, 0});
  limiter.trip(Fault::kStopped);
  EXPECT_GT(limited(limiter, {8, 0, 0}).x(), 4);
  limiter.sentNothing();
  EXPECT_TRUE(limiter.silent());
  EXPECT_EQ(limited(limiter, {8, 0, 0}).norm(), 0);
}

TEST(Limiter, AFaultTakesTheForceAwayTenTimesAsFastAsAPlannedEnd) {
  for (const Fault fault : {Fault::kStopped, Fault::kTooFast}) {
    Limiter limiter(generous(), 8.5);
    limited(limiter, {8, 0, 0}, 1e-4);
    limiter.trip(fault);
    double ticks = 0;
    while (limited(limiter, {8, 0, 0}, 1e-4).norm() > 0) ++ticks;
    EXPECT_NEAR(ticks * 1e-4, fault == Fault::kStopped ? 0.02 : Limiter::kFaultRamp, 1.1e-4);
  }
}

TEST(Limiter, CountsTheTicksInWhichALimitBound) {
  Limiter limiter(generous(), 8.5);
  limited(limiter, {8, 0, 0});
  limited(limiter, {9, 0, 0});
  limited(limiter, {10, 0, 0});
  EXPECT_EQ(limiter.clips().ticks[static_cast<size_t>(Limit::kForce)], 2u);
  EXPECT_EQ(limiter.clips().any, 2u);
}

TEST(Limiter, ForcesFlowOnlyWhileTheDeadManSwitchIsHeld) {
  scene::Limits limits = generous();
  limits.enable = {1, scene::EnableMode::kHold};
  Limiter limiter(limits, 8.5);
  EXPECT_EQ(limited(limiter, {4, 0, 0}).norm(), 0);
  limiter.watchButtons(0);
  limiter.watchButtons(2);
  EXPECT_EQ(limited(limiter, {4, 0, 0}).norm(), 4);
  limiter.watchButtons(1);  // another button
  double last = 4;
  for (int i = 0; i < 20; ++i) {
    const double force = limited(limiter, {8, 0, 0}).norm();
    EXPECT_LE(force, last * (1 + 1e-12));
    last = force;
  }
  EXPECT_EQ(last, 0) << "20 ms after it was let go";
  EXPECT_EQ(limiter.fault(), Fault::kNone) << "letting go is no fault";
}

/// A button that is taped down, or a cup on it: nobody holds it.
TEST(Limiter, ADeadManSwitchIsNotFoundPressed) {
  scene::Limits limits = generous();
  limits.enable = {1, scene::EnableMode::kHold};
  Limiter limiter(limits, 8.5);
  EXPECT_FALSE(limiter.foundPressed()) << "nothing is known yet";
  for (int i = 0; i < 5; ++i) {
    limiter.watchButtons(i == 3 ? std::nullopt : std::optional(2u));  // a lost sample is no release
    EXPECT_EQ(limited(limiter, {4, 0, 0}).norm(), 0) << i;
    EXPECT_TRUE(limiter.foundPressed());
  }
  limiter.watchButtons(1);  // another button
  EXPECT_FALSE(limiter.foundPressed());
  EXPECT_EQ(limited(limiter, {4, 0, 0}).norm(), 0);
  limiter.watchButtons(2);
  EXPECT_EQ(limited(limiter, {4, 0, 0}).norm(), 4);
  Limiter former(limits, 8.5);
  former.enableByFoundPressed();
  former.watchButtons(2);
  EXPECT_EQ(limited(former, {4, 0, 0}).norm(), 4) << "as in recordings of versions that let it";
}

TEST(Limiter, AToggleMustBePressedAndIsNotFoundPressed) {
  scene::Limits limits = generous();
  limits.enable = {0, scene::EnableMode::kToggle};
  Limiter limiter(limits, 8.5);
  limiter.watchButtons(1);  // held since before the start
  EXPECT_FALSE(limiter.enabled());
  limiter.watchButtons(0);
  limiter.watchButtons(1);
  limiter.watchButtons(1);
  EXPECT_TRUE(limiter.enabled());
  limiter.watchButtons(0);
  limiter.watchButtons(1);
  EXPECT_FALSE(limiter.enabled());
}

TEST(Limiter, AButtonHeldThroughALostSampleIsNotPressedAnew) {
  scene::Limits limits = generous();
  limits.enable = {0, scene::EnableMode::kToggle};
  Limiter limiter(limits, 8.5);
  for (const bool on : {false, true}) {
    EXPECT_EQ(limiter.enabled(), on);
    limiter.watchButtons(std::nullopt);
    limiter.watchButtons(1);
    EXPECT_EQ(limiter.enabled(), on);
    limiter.watchButtons(0);
    limiter.watchButtons(1);
  }
  limits.enable = {0, scene::EnableMode::kHold};
  Limiter held(limits, 8.5);
  held.watchButtons(0);
  held.watchButtons(1);
  held.watchButtons(std::nullopt);
  EXPECT_FALSE(held.enabled()) << "nobody knows that it is held";
}

TEST(Limiter, AnyFaultEndsInZeroForceWithinTwentyMillisecondsAndNeverRaisesIt) {
  for (int fault = 1; fault < kFaultCount; ++fault) {
    Limiter limiter(generous(), 8.5);
    limited(limiter, {5, -3, 1});
    limiter.trip(static_cast<Fault>(fault));
    double last = Vector3d(5, -3, 1).norm();
    for (int i = 0; i < 20; ++i) {
      const double force = limited(limiter, {8, 8, 8}).norm();
      EXPECT_LE(force, last);
      last = force;
    }
    EXPECT_EQ(last, 0) << describe(static_cast<Fault>(fault));
    EXPECT_TRUE(limiter.silent());
    EXPECT_EQ(limited(limiter, {8, 8, 8}).norm(), 0) << "a fault latches";
  }
}

TEST(Limiter, NotANumberTripsAndIsNeverPassedOn) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Limiter limiter(generous(), 8.5);
    limited(limiter, {2, 0, 0});
    const Vector3d force = limited(limiter, {bad, 0, 0});
    EXPECT_TRUE(force.allFinite());
    EXPECT_LE(force.norm(), 2);
    EXPECT_EQ(limiter.fault(), Fault::kNotFinite);
  }
}

TEST(Limiter, KeepsTheFirstFaultUntilTheUserClearsIt) {
  Limiter limiter(generous(), 8.5);
  limiter.trip(Fault::kDeviceLost);
  limiter.trip(Fault::kStale);
  EXPECT_EQ(limiter.fault(), Fault::kDeviceLost);
  while (!limiter.silent()) limited(limiter, {1, 0, 0});
  limiter.clear();
  EXPECT_EQ(limiter.fault(), Fault::kNone);
  EXPECT_GT(limited(limiter, {1, 0, 0}).norm(), 0);
}

TEST(Limiter, AFaultClearedOnItsWayDownGetsThereWithoutAStep) {
  Limiter limiter(generous(), 8.5);
  double last = 0;
  for (int i = 0; i < 2000; ++i) last = limited(limiter, {2, 0, 0}).norm();
  limiter.trip(Fault::kStopped);
  const double step = last - limited(limiter, {2, 0, 0}).norm();
  limiter.clear();
  last -= step;
  while (limiter.fault() != Fault::kNone) {
    const double force = limited(limiter, {2, 0, 0}).norm();
    ASSERT_LE(force, last);
    ASSERT_LE(last - force, 1.01 * step);
    last = force;
  }
  EXPECT_EQ(last, 0);
  EXPECT_GT(limited(limiter, {2, 0, 0}).norm(), 0) << "it was cleared";
}

TEST(Limiter, AFaultAfterTheUsersOrderStaysLatched) {
  Limiter limiter(generous(), 8.5);
  for (int i = 0; i < 2000; ++i) limited(limiter, {2, 0, 0});
  limiter.trip(Fault::kStopped);
  limited(limiter, {2, 0, 0});
  limiter.clear();
  limiter.trip(Fault::kTooFast);
  for (int i = 0; i < 100; ++i) limited(limiter, {2, 0, 0});
  EXPECT_TRUE(limiter.silent());
}

TEST(Limiter, SpeedThatIsNotANumberIsTooFast) {
  scene::Limits limits = generous();
  limits.velocity = 3;
  Limiter limiter(limits, 8.5);
  limiter.watchSpeed(2.9);
  EXPECT_EQ(limiter.fault(), Fault::kNone);
  limiter.watchSpeed(std::nan(""));
  EXPECT_EQ(limiter.fault(), Fault::kTooFast);
}

}  // namespace
}  // namespace hapticd::servo
