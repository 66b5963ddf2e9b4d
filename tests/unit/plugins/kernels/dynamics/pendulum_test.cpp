// SPDX-License-Identifier: MIT
#include "kernels/dynamics/pendulum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "support/sweep.hpp"

namespace hapticd::dynamics {
namespace {

TEST(Pendulum, KeepsItsEnergyForMillionsOfTicks) {
  const PendulumLaw law;
  PendulumState state{2, 0};
  const double before = energy(law, state);
  double worst = 0;
  const int ticks = support::kLong ? 10'000'000 : 1'000'000;
  for (int i = 0; i < ticks; ++i) {
    state = advance(law, state, 0, 1.0 / 1500);
    if (i % 1000 == 0) worst = std::fmax(worst, std::fabs(energy(law, state) / before - 1));
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 1e-9);
}

TEST(Pendulum, KeepsItsEnergyHoweverShortAndWhetherItSwingsOrGoesRound) {
  for (const double length : {10.0, 0.1, 0.01, 0.001})
    for (const double rate : {0.0, 1.0, 3.0}) {  // over the linear frequency
      PendulumLaw law;
      law.length = length;
      law.inertia = length * length;
      PendulumState state{2, rate * std::sqrt(law.frequencySquared())};
      const double before = energy(law, state);
      double worst = 0;
      for (int i = 0; i < 200'000; ++i) {
        state = advance(law, state, 0, 1.0 / 1500);
        state.angle = std::remainder(state.angle, 2 * M_PI);
        worst = std::fmax(worst, std::fabs(energy(law, state) / before - 1));
      }
      EXPECT_LT(worst, 1e-9) << "length " << length << ", rate " << rate;
    }
}

PendulumState after(const PendulumLaw& law, int steps) {
  PendulumState state{1, 0};
  for (int i = 0; i < steps; ++i) state = advance(law, state, 0.3, 2.0 / steps);
  return state;
}

TEST(Pendulum, ConvergesWithTheOrderItClaims) {
  // damping: none, weak (fourth order), strong at these steps (second order)
  for (const auto& [damping, steps, order] : {std::tuple{0.0, 100, 4}, {0.3, 400, 4}, {300.0, 400, 2}}) {
    PendulumLaw law;
    law.damping = damping;
    const PendulumState truth = after(law, 64 * steps);
    const auto error = [&](int n) {
      const PendulumState at = after(law, n);
      return std::hypot(at.angle - truth.angle, at.rate - truth.rate);
    };
    EXPECT_NEAR(std::log2(error(steps) / error(2 * steps)), order, 0.25) << "damping " << damping;
  }
}

TEST(Pendulum, IsStableUpToItsLargestSwing) {
  for (const double damping : {0.0, 1e-3, 0.03, 0.3, 2.0, 30.0})
    for (double phase = 0.25; phase <= kLargestSwing; phase *= support::kLong ? 1.1 : 1.4) {
      PendulumLaw law;
      law.gravity = 1;  // 1 rad/s
      law.damping = damping;
      PendulumState state{1, 0};
      const double before = energy(law, state);
      for (int i = 0; i < 5000; ++i) {
        state = advance(law, state, 0, phase);
        ASSERT_LE(energy(law, state), before * 1.01) << "damping " << damping << ", phase " << phase;
      }
    }
}

TEST(Pendulum, RefusesASwingThatTheRateCannotFollowAndSaysWhatItCan) {
  EXPECT_NO_THROW(validateSwing(32e3, 1000));
  EXPECT_NO_THROW(validateSwing(1e9, 0));
  try {
    validateSwing(48e3, 1000);
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("at most 3.2e+04 rad/s at 1000 Hz"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("1500 Hz"), std::string::npos) << e.what();
  }
}

TEST(Pendulum, SettlesWhereTheTorqueBalancesItsWeight) {
  PendulumLaw law;
  law.damping = 2;
  PendulumState state;
  for (int i = 0; i < 100'000; ++i) state = advance(law, state, 4.0, 1e-3);
  EXPECT_NEAR(std::sin(state.angle) * 9.81, 4.0, 1e-9);
  EXPECT_NEAR(state.rate, 0, 1e-12);
}

TEST(Pendulum, SwingsWithThePeriodOfTheEllipticIntegral) {
  const PendulumLaw law;
  for (const double amplitude : {0.01, 1.0, 3.0}) {
    const double quarter = period(law, amplitude) / 4;
    PendulumState state{amplitude, 0};
    for (int i = 0; i < 4000; ++i) state = advance(law, state, 0, quarter / 4000);
    EXPECT_NEAR(state.angle, 0, 1e-10) << amplitude;
    EXPECT_NEAR(energy(law, state), energy(law, {amplitude, 0}), 1e-10);
  }
}

}  // namespace
}  // namespace hapticd::dynamics
