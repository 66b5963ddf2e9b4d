// SPDX-License-Identifier: MIT
/// Power at every moment and impulse over every window: the limits that reckon with what the hand does.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "limiter_rig.hpp"
#include "servo/velocity/probe_velocity.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

TEST(Limiter, PowerGivenToTheHandIsBoundedAndPowerTakenIsNot) {
  scene::Limits limits = generous();
  limits.power = 0.5;
  Limiter limiter(limits, 0);
  limiter.watchVelocity({0.5, 0, 0});
  EXPECT_NEAR(limited(limiter, {4, 0, 0}).x(), 1.0, 1e-12);
  EXPECT_EQ(limited(limiter, {-4, 0, 0}).x(), -4) << "a wall that brakes the hand";
  EXPECT_EQ(limiter.clips().ticks[static_cast<size_t>(Limit::kPower)], 1u);
}

TEST(Limiter, PowerIsBoundedAlsoWhereTheForceMustTurnRound) {
  scene::Limits limits = generous();
  limits.power = 0.5;
  limits.slew = 500;
  Limiter limiter(limits, 0);
  limiter.watchVelocity({-1, 0, 0});
  for (int i = 0; i < 20; ++i) limited(limiter, {8, 0, 0});  // it brakes the hand
  limiter.watchVelocity({1, 0, 0});                          // which is thrown back
  for (int i = 0; i < 20; ++i) EXPECT_LE(limited(limiter, {-8, 0, 0}).x(), 0.5 + 1e-12) << i;
}

TEST(Limiter, ImpulseOfAHeldForceFallsWithoutAStep) {
  scene::Limits limits = generous();
  limits.impulse = 0.2;
  Limiter limiter(limits, 0);
  std::vector<double> forces;
  for (int i = 0; i < 1000; ++i) forces.push_back(limited(limiter, {8, 0, 0}).x());
  EXPECT_EQ(forces.front(), 8) << "a short push is let through";
  EXPECT_NEAR(forces.back(), 1, 0.01) << "what lasts ends at half the impulse over the window";
  for (size_t i = 1; i < forces.size(); ++i) EXPECT_LE(forces[i], forces[i - 1] + 1e-9);
}

/// Wherever the window begins, at every rate, with ticks that come late: random pushes from all sides.
TEST(Limiter, ImpulseOfEveryWindowStaysBelowItsLimit) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1), side(-1, 1);
  for (int run = 0; run < 60; ++run) {
    scene::Limits limits = generous();
    limits.impulse = 0.02 + 0.5 * unit(random);
    const double period = 1 / (run % 3 == 0 ? 500.0 : run % 3 == 1 ? 1000.0 : 8000.0);
    Limiter limiter(limits, 0);
    std::vector<std::pair<double, double>> held;  // how long, how much
    Vector3d push = Vector3d::Zero();
    for (double t = 0; t < 1; t += held.back().first) {
      if (unit(random) < 20 * period) push = Vector3d(side(random), side(random), side(random)) * 12;
      const double force = limited(limiter, push, held.empty() ? period : held.back().first).norm();
      held.emplace_back(period * (unit(random) < 0.05 ? 3 : 0.9 + 0.2 * unit(random)), force);
    }
    double sum = 0, length = 0, most = 0;
    for (size_t begin = 0, end = 0; end < held.size(); ++end) {
      sum += held[end].first * held[end].second, length += held[end].first;
      for (; length > Limiter::kImpulseWindow; ++begin)
        sum -= held[begin].first * held[begin].second, length -= held[begin].first;
      most = std::max(most, sum);
    }
    ASSERT_LE(most, limits.impulse * (1 + 1e-9)) << "run " << run << ", " << 1 / period << " Hz";
    EXPECT_GT(most, 0.3 * limits.impulse) << "and it is of use";
  }
}

/// A hand that moves by three waves along each axis, with speeds and accelerations of a hand.
struct Motion {
  explicit Motion(std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0, 1), side(-1, 1);
    for (auto& wave : waves)
      for (int i = 0; i < 3; ++i)
        wave[i] = {0.05 * side(random), 2 * M_PI * (0.5 + 4 * unit(random)), 3 * side(random)};
  }
  Vector3d at(double t, bool velocity) const {
    Vector3d sum = Vector3d::Zero();
    for (const auto& wave : waves)
      for (int i = 0; i < 3; ++i) {
        const Wave& w = wave[i];
        const double phase = w.frequency * t + w.phase;
        sum[i] += velocity ? w.size * w.frequency * std::cos(phase) : w.size * std::sin(phase);
      }
    return sum;
  }
  struct Wave {
    double size, frequency, phase;
  };
  Wave waves[3][3];
};

/// Through the estimator that ships: the power at any moment until the next command.
TEST(Limiter, PowerStaysBelowItsLimitOverRandomMotions) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0, 1), side(-1, 1);
  for (int run = 0; run < 100; ++run) {
    const double rate = run % 2 == 0 ? 1000 : 5000, dt = 1 / rate;
    scene::Limits limits = generous();
    limits.power = 0.1 + unit(random);
    Limiter limiter(limits, 0);
    limiter.expectMotion(1.5 * dt, 0);
    ProbeVelocity velocity(*makeEstimator({}, rate));
    const Motion hand(random);
    Vector3d push = Vector3d::Ones() * 4;
    double most = 0;
    for (double t = 0; t < 2; t += dt) {
      if (unit(random) < 5 * dt) push = Vector3d(side(random), side(random), side(random)) * 8;
      limiter.watchVelocity(velocity.update(hand.at(t, false), t == 0 ? 0 : dt));
      const Vector3d force = limited(limiter, push, dt);
      if (t < 0.05) continue;  // the estimator starts
      for (double held = 0; held <= dt; held += dt / 4) most = std::max(most, force.dot(hand.at(t + held, true)));
    }
    ASSERT_LE(most, limits.power) << "run " << run;
    EXPECT_GT(most, 0.3 * limits.power) << "and it is of use";
  }
}

/// Nothing holds the tip: the force itself makes it fast before the next command comes.
TEST(Limiter, PowerStaysBelowItsLimitOnATipThatNobodyHolds) {
  for (const double mass : {0.05, 0.075, 0.5})
    for (const double rate : {500.0, 1000.0, 4000.0}) {
      scene::Limits limits = generous();
      limits.power = 0.2;
      Limiter limiter(limits, 8.5);
      limiter.expectMotion(0, mass);
      double v = 0, most = 0;
      for (int i = 0; i < 1000; ++i) {
        limiter.watchVelocity({v, 0, 0});
        const double force = limited(limiter, {8, 0, 0}, 1 / rate).x();
        v += force / mass / rate;
        most = std::max(most, force * v);
        ASSERT_LE(force * v, limits.power * (1 + 1e-9)) << mass << " kg, " << rate << " Hz, tick " << i;
      }
      EXPECT_GT(most, 0.1 * limits.power);
    }
}

}  // namespace
}  // namespace hapticd::servo
