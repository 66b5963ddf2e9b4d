// SPDX-License-Identifier: MIT
/// Pushes of programs: what is steady or slow reaches the hand as it was asked for, what makes a hand swing is damped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <random>

#include "servo/safety/passivity/controller.hpp"

namespace hapticd::passivity {
namespace {

using Eigen::Vector3d;
constexpr double kPushPeriod = 1e-3, kPushStep = 25e-6;  ///< [s], [m] of the encoder
constexpr double kStrongest = 8.5;                       ///< [N] of the arm

/// A hand that holds a light arm: 275 g on a spring. It trembles, and follows what it has in mind.
struct HeldArm {
  double stiffness = 500;                                           ///< [N/m]
  double damping = 5;                                               ///< [N s/m]
  double tremor = 0.02;                                             ///< [N]
  std::function<double(double)> mind = [](double) { return 0.0; };  ///< [m] at a time [s]
  std::function<double(double, double)> program;                    ///< [N] at a position seen [m] and a time [s]
  int delay = 0;                                                    ///< ticks until the program's force is there
};

struct Felt {
  double off = 0;    ///< [N] root mean square of what was sent less what the program asked for, second half
  double swing = 0;  ///< [m] of the hand, second half
  double work = 0;   ///< [J] that the force did on the hand, second half
};

enum class Law { kNone, kFormer, kNow };

Felt hold(const HeldArm& arm, Law law) {
  constexpr int kTicks = 8000, kParts = 20;
  constexpr double kPart = kPushPeriod / kParts, kTremorTime = 0.05;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  PassivityController controller(stableDamping(0.075, kPushPeriod), 0, kPushStep);
  std::deque<double> on_the_way(static_cast<size_t>(arm.delay), 0.0);
  double x = 0, v = 0, tremble = 0, off = 0, low = 1e9, high = -1e9;
  Felt felt;
  for (int i = 0; i < kTicks; ++i) {
    const double t = i * kPushPeriod, seen = std::round(x / kPushStep) * kPushStep;
    on_the_way.push_back(std::min(1.0, t / 0.05) * arm.program(seen, t));
    const double asked = std::clamp(on_the_way.front(), -kStrongest, kStrongest);
    on_the_way.pop_front();
    double sent = asked;
    Exchange exchange;
    exchange.pushed = law == Law::kNow;
    if (law != Law::kNone) sent = controller.update({seen, 0, 0}, {asked, 0, 0}, kPushPeriod, exchange).x();
    sent = std::clamp(sent, -kStrongest, kStrongest);
    controller.applied({sent, 0, 0});
    const double from = x;
    for (int k = 0; k < kParts; ++k) {
      tremble += -tremble * kPart / kTremorTime + arm.tremor * normal(random) * std::sqrt(kPart / kTremorTime);
      v += (sent + arm.stiffness * (arm.mind(t) - x) - arm.damping * v + tremble) / 0.275 * kPart;
      x += v * kPart;
    }
    if (i < kTicks / 2) continue;
    off += (sent - asked) * (sent - asked) / (kTicks / 2.0);
    low = std::min(low, x), high = std::max(high, x);
    felt.work += sent * (x - from);
  }
  felt.off = std::sqrt(off), felt.swing = high - low;
  return felt;
}

HeldArm onASpring(double stiffness, int delay) {
  HeldArm arm;
  arm.program = [stiffness](double seen, double) { return 0.7 - stiffness * seen; };
  arm.delay = delay;
  return arm;
}

TEST(Pushed, ASteadyPushReachesTheHandAsItWasAskedFor) {
  HeldArm arm;
  arm.program = [](double, double) { return 0.7; };
  EXPECT_GT(hold(arm, Law::kFormer).off, 0.02) << "what this law is about";
  EXPECT_LT(hold(arm, Law::kNow).off, 1e-3);
}

TEST(Pushed, SoDoesASoftSpringHoweverLate) {
  for (const double stiffness : {100.0, 200.0, 400.0, 800.0})
    for (int delay = 0; delay < 4; ++delay) {
      EXPECT_GT(hold(onASpring(stiffness, delay), Law::kFormer).off, 0.02) << stiffness << " N/m, delay " << delay;
      EXPECT_LT(hold(onASpring(stiffness, delay), Law::kNow).off, 2e-3) << stiffness << " N/m, delay " << delay;
    }
}

TEST(Pushed, SoDoesASpringThatTheHandMovesThroughSlowly) {
  for (const double stiffness : {100.0, 200.0, 400.0})
    for (int delay = 0; delay < 4; ++delay) {
      HeldArm arm = onASpring(stiffness, delay);
      arm.mind = [](double t) { return 0.01 * std::sin(2 * M_PI * 0.2 * t); };
      EXPECT_LT(hold(arm, Law::kNow).off, 2e-3) << stiffness << " N/m, delay " << delay;
    }
}

TEST(Pushed, AForceThatChangesSlowlyIsTheProgramsToGive) {
  HeldArm arm;
  arm.program = [](double, double t) { return 1.0 + 0.5 * std::sin(2 * M_PI * 0.1 * t); };
  EXPECT_LT(hold(arm, Law::kNow).off, 2e-3);
  EXPECT_LT(hold(arm, Law::kNow).off, hold(arm, Law::kFormer).off / 10);
}

/// Each throws the hand about when nothing is done about it.
TEST(Pushed, AStiffSpringThatComesLateIsCalmedAsBefore) {
  for (const auto& [stiffness, delay] : {std::pair(2000.0, 3), {8000.0, 1}}) {
    const HeldArm arm = onASpring(stiffness, delay);
    const double alone = hold(arm, Law::kNone).swing;
    EXPECT_GT(alone, 5e-3) << stiffness;
    EXPECT_LT(hold(arm, Law::kNow).swing, alone / 20) << stiffness << " N/m, delay " << delay;
  }
  for (const int delay : {2, 3}) {  // too late for any damping: what can be taken out is
    const HeldArm arm = onASpring(8000, delay);
    EXPECT_LT(hold(arm, Law::kNow).swing, 0.7 * hold(arm, Law::kNone).swing) << "delay " << delay;
    EXPECT_LT(hold(arm, Law::kNow).swing, 1.1 * hold(arm, Law::kFormer).swing) << "delay " << delay;
  }
}

/// 0.7 N, and a push along the speed of a hand of 1 N s/m, which so swings ever farther at its own 2, 7 and 12 Hz.
TEST(Pushed, APushAlongTheSpeedOfTheHandIsTakenOut) {
  for (const double stiffness : {43.0, 500.0, 1560.0})
    for (int delay = 1; delay < 4; ++delay) {
      HeldArm arm;
      arm.stiffness = stiffness;
      arm.damping = 1;
      arm.delay = delay;
      const auto driven = [&arm](Law law) {
        double last = 0, speed = 0;
        arm.program = [&](double seen, double) {
          speed += 0.1 * ((seen - last) / kPushPeriod - speed);
          last = seen;
          return 0.7 + 5 * speed;
        };
        return hold(arm, law);
      };
      const Felt alone = driven(Law::kNone), calmed = driven(Law::kNow), former = driven(Law::kFormer);
      EXPECT_GT(alone.work, 0.1) << stiffness << " N/m, delay " << delay;
      EXPECT_LT(calmed.work, alone.work / 50) << stiffness << " N/m, delay " << delay << ": once " << former.work;
      EXPECT_LT(calmed.swing, alone.swing / 10) << stiffness << " N/m, delay " << delay << ": once " << former.swing;
    }
}

TEST(Pushed, WhoLeavesTakesItsDebtAlong) {
  PassivityController controller(18.75, 0, kPushStep);
  Exchange pushed;
  pushed.pushed = true;
  double x = 0;
  for (int i = 0; i < 4000; ++i)
    controller.update({x += 1e-5, 0, 0}, {3, 0, 0}, kPushPeriod, pushed);  // 40 mm with 3 N
  EXPECT_LT(controller.energy(), -0.1);
  EXPECT_GT(controller.swing(), -1e-3);
  const Vector3d wall(-1, 0, 0);
  for (int i = 0; i < 100; ++i)  // the program leaves, and a wall is touched
    EXPECT_LT((controller.update({x += 1e-5, 0, 0}, wall, kPushPeriod) - wall).norm(), 0.02) << i;
  for (int i = 0; i < 200; ++i)  // a wall that gives more than it got, and a program that says nothing meanwhile
    controller.update({x -= 1e-5, 0, 0}, wall, kPushPeriod, i < 150 ? Exchange{} : pushed);
  EXPECT_LT(controller.swing(), -1e-5);
  EXPECT_GT(controller.damping(), 1);
}

}  // namespace
}  // namespace hapticd::passivity
