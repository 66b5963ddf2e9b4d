// SPDX-License-Identifier: MIT
#include "servo/safety/passivity/controller.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>

namespace hapticd::passivity {
namespace {

using Eigen::Vector3d;
constexpr double kPeriod = 1e-3;

/// A mass of 75 g with friction 0.1 N s/m pressed with 2 N on a wall of `stiffness`; the largest swing of the last
/// second.
double swingOf(double stiffness, PassivityController* controller) {
  double x = 1e-4, v = 0, low = 1e9, high = -1e9;
  for (int i = 0; i < 5000; ++i) {
    Vector3d force(x > 0 ? -stiffness * x : 0, 0, 0);
    if (controller != nullptr) force = controller->update({x, 0, 0}, force, kPeriod);
    for (int k = 0; k < 50; ++k) {
      v += (force.x() + 2.0 - 0.1 * v) / 0.075 * kPeriod / 50;
      x += v * kPeriod / 50;
    }
    if (i < 4000) continue;
    low = std::min(low, x), high = std::max(high, x);
  }
  return high - low;
}

TEST(Controller, TakesEnergyOnlyWhenTheBooksAreNegative) {
  PassivityController controller(50);
  for (int i = 0; i < 100; ++i) {  // pressed in: the hand gives energy
    controller.update({-1e-5 * i, 0, 0}, {0.01 * i + 1e-3, 0, 0}, 1e-3);
    EXPECT_EQ(controller.damping(), 0);
  }
  for (int i = 0; i < 100; ++i)  // an active wall gives back more
    controller.update({-1e-3 + 1e-5 * i, 0, 0}, {5, 0, 0}, 1e-3);
  EXPECT_GT(controller.dissipated(), 0);
}

TEST(Controller, AContactBeginsWithoutTheCreditOfTheLastOne) {
  PassivityController controller(50);
  for (int i = 0; i < 100; ++i) controller.update({-1e-4 * i, 0, 0}, {2, 0, 0}, kPeriod);  // the hand gives 20 mJ
  EXPECT_GT(controller.energy(), 0.01);
  controller.update({-0.01, 0, 0}, {0, 0, 0}, kPeriod);
  EXPECT_LE(controller.energy(), 0);
}

TEST(Controller, CalmsAWallTenTimesTooStiff) {
  const double stiffness = 10 * 2 * 0.1 / kPeriod;
  PassivityController controller(stableDamping(0.075, kPeriod), 0.1);
  const double alone = swingOf(stiffness, nullptr), calmed = swingOf(stiffness, &controller);
  EXPECT_GT(alone, 10e-3);
  EXPECT_LT(calmed, alone / 20);
  EXPECT_GT(controller.dissipated(), 0);
}

TEST(Controller, LeavesASoftWallAlone) {
  PassivityController controller(37.5, 0.1);
  EXPECT_EQ(swingOf(150, nullptr), swingOf(150, &controller));
  EXPECT_EQ(controller.dissipated(), 0);
}

/// What a motor got in four strokes of a hand into a wall and out again.
struct Strokes {
  double jump = 0, variation = 0;              ///< [N] largest change between two ticks, and the sum of all
  double model_jump = 0, model_variation = 0;  ///< of the wall's own force
  double swing = 0;                            ///< [m] of the tip in the last second
};

/// A light arm of 275 g with its hand, on a spring of 500 N/m that goes 30 mm in and out each second. Positions are
/// counted in steps of 25 um; one in seven samples is a tick late; a force acts `delay` ticks late.
Strokes stroke(double stiffness, int delay, double step, PassivityController* controller) {
  double x = -1e-3, v = 0, seen = x, last_model = 0, last_sent = 0, low = 1e9, high = -1e9;
  std::deque<double> on_the_way(static_cast<size_t>(delay), 0.0);
  Strokes strokes;
  for (int i = 0; i < 4000; ++i) {
    if (i % 7 != 3) seen = step > 0 ? std::round(x / step) * step : x;
    const double model = seen > 0 ? -stiffness * seen : 0;
    double sent = model;
    if (controller != nullptr) sent = controller->update({seen, 0, 0}, {model, 0, 0}, kPeriod, {0, -model * seen}).x();
    strokes.jump = std::max(strokes.jump, std::abs(sent - last_sent));
    strokes.model_jump = std::max(strokes.model_jump, std::abs(model - last_model));
    strokes.variation += std::abs(sent - last_sent), strokes.model_variation += std::abs(model - last_model);
    last_model = model, last_sent = sent;
    on_the_way.push_back(sent);
    const double held = on_the_way.front();
    on_the_way.pop_front();
    for (int k = 0; k < 50; ++k) {
      const double phase = 2 * M_PI * (i + k / 50.0) * kPeriod;
      const double target = 0.015 * (1 - std::cos(phase)), speed = 0.015 * 2 * M_PI * std::sin(phase);
      v += (held + 500 * (target - x) + 5 * (speed - v)) / 0.275 * kPeriod / 50;
      x += v * kPeriod / 50;
    }
    if (i > 3000) low = std::min(low, x), high = std::max(high, x);
  }
  strokes.swing = high - low;
  return strokes;
}

constexpr double kStep = 25e-6;
PassivityController ofAnUntriedArm() {
  return PassivityController(stableDamping(0.075, kPeriod), 0, kStep);
}

TEST(Controller, DoesNotChatterWhereCountsAndDelayMakeLittleEnergy) {
  for (const double stiffness : {400.0, 800.0, 2000.0})
    for (int delay = 0; delay < (stiffness < 2000 ? 3 : 2); ++delay) {
      PassivityController controller = ofAnUntriedArm();
      const Strokes strokes = stroke(stiffness, delay, kStep, &controller);
      EXPECT_LT(strokes.jump, strokes.model_jump + 0.1) << stiffness << " N/m, delay " << delay;
      EXPECT_LT(strokes.variation, 1.25 * strokes.model_variation) << stiffness << " N/m, delay " << delay;
      EXPECT_GT(controller.dissipated(), 0) << "nothing was asked of it";
    }
}

TEST(Controller, CalmsAHandThatADelayedWallThrowsOff) {
  for (const int delay : {2, 3}) {
    PassivityController controller = ofAnUntriedArm();
    const double stiffness = delay == 2 ? 3500 : 2000;
    const Strokes alone = stroke(stiffness, delay, kStep, nullptr);
    const Strokes calmed = stroke(stiffness, delay, kStep, &controller);
    EXPECT_LT(calmed.swing, alone.swing / 2) << "delay " << delay;
    EXPECT_LT(calmed.variation, alone.variation / 2) << "delay " << delay;
  }
}

TEST(Controller, TurnsNoForceRoundAndAtMostDoublesIt) {
  for (const double stiffness : {1000.0, 2000.0, 3500.0}) {
    PassivityController controller = ofAnUntriedArm();
    double x = 1e-4, v = 0;
    for (int i = 0; i < 3000; ++i) {
      const double model = x > 0 ? -stiffness * x : 0;
      const Vector3d sent = controller.update({x, 0, 0}, {model, 0, 0}, kPeriod);
      ASSERT_LE(sent.x(), 1e-12) << i;
      ASSERT_GE(sent.x(), 2 * model - 1e-12) << i;
      for (int k = 0; k < 20; ++k) {
        v += (sent.x() + 2.0 - 0.1 * v) / 0.075 * kPeriod / 20;
        x += v * kPeriod / 20;
      }
    }
    EXPECT_GT(controller.dissipated(), 0) << stiffness;
  }
}

/// A bare arm that nobody holds but a push of 2 N, on a wall, by a device of at most 8.5 N that acts `delay` ticks
/// late.
struct BareArm {
  double mass, friction, stiffness, period;
  int delay;

  /// Kinetic energy [J] in the mean of the last two of four seconds.
  double energy(PassivityController* controller, bool pushed = false) const {
    constexpr int kParts = 20;
    double x = 1e-4, v = 0, sum = 0;
    std::deque<double> on_the_way(static_cast<size_t>(delay), 0.0);
    const int ticks = static_cast<int>(4.0 / period);
    for (int i = 0; i < ticks; ++i) {
      const double seen = std::round(x / kStep) * kStep, model = seen > 0 ? -stiffness * seen : 0;
      double sent = model;
      if (controller != nullptr)
        sent = controller->update({seen, 0, 0}, {model, 0, 0}, period, {0, -model * seen, pushed}).x();
      sent = std::max(sent, -8.5);
      if (controller != nullptr) controller->applied({sent, 0, 0});
      on_the_way.push_back(sent);
      const double held = on_the_way.front();
      on_the_way.pop_front();
      for (int k = 0; k < kParts; ++k) {
        v += (held + 2.0 - friction * v) / mass * period / kParts;
        x += v * period / kParts;
      }
      if (i > ticks / 2) sum += mass * v * v / ticks;
    }
    return sum;
  }
};

TEST(Controller, MakesNoArmWorseWhateverItsMassItsDelayAndTheWall) {
  double alone_sum = 0, calmed_sum = 0, by_program_sum = 0;
  for (const double period : {1e-3, 2.5e-4})
    for (const double mass : {0.05, 0.075, 0.15, 0.5})
      for (const double stiffness : {200.0, 800.0, 2000.0, 3500.0, 8000.0})
        for (int delay = 0; delay < 4; ++delay) {
          const BareArm arm{mass, 0.1, stiffness, period, delay};
          PassivityController controller(stableDamping(mass, period), arm.friction, kStep);
          PassivityController pushed = controller;
          const double alone = arm.energy(nullptr), calmed = arm.energy(&controller);
          // A tenth: no two limit cycles are phased alike. Nanojoules are counts of the encoder.
          EXPECT_LE(calmed, 1.1 * alone + 1e-8)
              << mass << " kg, " << stiffness << " N/m, delay " << delay << " of " << period;
          const double by_program = arm.energy(&pushed, true);  // the wall is a program's
          EXPECT_LE(by_program, 1.1 * alone + 1e-7)
              << mass << " kg, " << stiffness << " N/m, delay " << delay << " of " << period << ", by a program";
          alone_sum += alone, calmed_sum += calmed, by_program_sum += by_program;
        }
  EXPECT_LT(calmed_sum, 0.8 * alone_sum);
  EXPECT_LT(by_program_sum, 0.8 * alone_sum);
}

TEST(Controller, DoesNotTakeAPushOfAMovingModelForEnergyFromNowhere) {
  // A model carries the hand along at 0.1 m/s with 3 N: 0.3 W, rightly given.
  PassivityController told(37.5), untold(37.5);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d position(1e-4 * i, 0, 0), force(3, 0, 0);
    const Exchange exchange{i == 0 ? 0 : 3 * 1e-4};
    EXPECT_LT((told.update(position, force, kPeriod, exchange) - force).norm(), 1e-9);
    untold.update(position, force, kPeriod);
  }
  EXPECT_NEAR(told.dissipated(), 0, 1e-12);
  EXPECT_GT(untold.dissipated(), 0.01);
}

TEST(Controller, ForgetsCreditThatNoContactCanGiveBack) {
  // A minute of stroking through a viscous contact pays in joules; the wall holds a millijoule.
  PassivityController capped(37.5), uncapped(37.5);
  double x = 0;
  for (int i = 0; i < 60000; ++i) {
    x += 1e-4;
    capped.update({x, 0, 0}, {-1, 0, 0}, kPeriod, {0, 1e-3});
    uncapped.update({x, 0, 0}, {-1, 0, 0}, kPeriod);
  }
  EXPECT_LE(capped.energy(), 1e-3);
  EXPECT_GT(uncapped.energy(), 5);
  for (int i = 0; i < 100; ++i) {  // now it gives 0.1 mJ a tick away
    x += 1e-4;
    capped.update({x, 0, 0}, {1, 0, 0}, kPeriod, {0, 1e-3});
    uncapped.update({x, 0, 0}, {1, 0, 0}, kPeriod);
  }
  EXPECT_GT(capped.dissipated(), 0);
  EXPECT_EQ(uncapped.dissipated(), 0) << "the old credit hides it";
}

TEST(Controller, BooksWhatTheLimitsLeftOfTheForce) {
  PassivityController controller(37.5);
  for (int i = 0; i < 100; ++i) {
    controller.update({-1e-5 * i, 0, 0}, {10, 0, 0}, kPeriod);
    controller.applied({1, 0, 0});
  }
  EXPECT_NEAR(controller.energy(), 1 * 99e-5, 1e-12);
}

TEST(Controller, SurvivesNonsense) {
  PassivityController controller(37.5);
  const double nan = std::nan("");
  for (int i = 0; i < 100; ++i) {
    const Vector3d position(i % 7 == 3 ? nan : 1e-5 * i, 0, 0), force(i % 5 == 2 ? nan : 1, 0, 0);
    const Vector3d result = controller.update(position, force, i % 11 == 5 ? nan : kPeriod, {nan, nan});
    EXPECT_EQ(result.allFinite(), force.allFinite()) << "a fault that the limiter must see, and nothing else";
    controller.applied({i % 13 == 1 ? nan : 1, 0, 0});
  }
  EXPECT_TRUE(std::isfinite(controller.energy()));
}

}  // namespace
}  // namespace hapticd::passivity
