// SPDX-License-Identifier: MIT
#include "kernels/dynamics/torsion_spring.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/sweep.hpp"

namespace hapticd::dynamics {
namespace {

PendulumLaw weightless(double inertia, double damping = 0) {
  PendulumLaw law;
  law.inertia = inertia;
  law.damping = damping;
  law.gravity = 0;
  return law;
}

double energyOf(const PendulumLaw& law, const TorsionSpring& spring, const PendulumState& state) {
  const double away = state.angle - spring.rest;
  return energy(law, state) + 0.5 * spring.stiffness * away * away;
}

TEST(TorsionSpring, SwingsWithTheRootOfStiffnessOverInertiaAtEveryRate) {
  for (const double rate : {500.0, 1000.0, 4000.0, 10'000.0})
    for (const double stiffness : {0.01, 2.0, 400.0}) {
      const PendulumLaw law = weightless(0.02);
      const TorsionSpring spring{stiffness, 0.3};
      const double w = std::sqrt(stiffness / law.inertia);
      PendulumState state{0.8, 0};
      for (int i = 1; i <= 5000; ++i) {
        state = advance(law, spring, state, 0, 1 / rate);
        ASSERT_NEAR(state.angle, 0.3 + 0.5 * std::cos(w * i / rate), 1e-10) << rate << ' ' << stiffness;
      }
    }
}

TEST(TorsionSpring, DecaysAsTheClosedFormSays) {
  const PendulumLaw law = weightless(0.02, 0.1);
  const TorsionSpring spring{3, -0.2};
  PendulumState state{0.5, 0};
  const double half = 0.1 / 0.04, w = std::sqrt(3 / 0.02 - half * half);
  for (int i = 1; i <= 2000; ++i) {
    state = advance(law, spring, state, 0, 1e-3);
    const double t = i * 1e-3;
    ASSERT_NEAR(state.angle, -0.2 + 0.7 * std::exp(-half * t) * (std::cos(w * t) + half / w * std::sin(w * t)), 1e-12);
  }
}

TEST(TorsionSpring, RestsWhereTorqueWeightAndSpringBalance) {
  PendulumLaw law;
  law.damping = 2;
  const TorsionSpring spring{20, 0.4};
  PendulumState state;
  for (int i = 0; i < 100'000; ++i) state = advance(law, spring, state, 4.0, 1e-3);
  EXPECT_NEAR(20 * (state.angle - 0.4) + 9.81 * std::sin(state.angle), 4.0, 1e-6);
  EXPECT_NEAR(state.rate, 0, 1e-9);
}

TEST(TorsionSpring, WithAWeightConvergesWithSecondOrder) {
  for (const double damping : {0.0, 0.3, 300.0}) {
    PendulumLaw law;
    law.damping = damping;
    const auto after = [&](int steps) {
      PendulumState state{1, 0};
      for (int i = 0; i < steps; ++i) state = advance(law, {30, 0.2}, state, 0.3, 2.0 / steps);
      return state;
    };
    const PendulumState truth = after(64'000);
    const auto error = [&](int steps) {
      const PendulumState at = after(steps);
      return std::hypot(at.angle - truth.angle, at.rate - truth.rate);
    };
    EXPECT_NEAR(std::log2(error(1000) / error(2000)), 2, 0.1) << "damping " << damping;
  }
}

TEST(TorsionSpring, WithoutAWeightNeverGainsEnergyWhateverItsStiffnessAndInertia) {
  int cases = 0;
  for (double stiffness = 1e-3; stiffness < 2e6; stiffness *= 10)
    for (double inertia = 1e-9; inertia < 2e3; inertia *= 10)
      for (const double dt : {1e-4, 2.5e-4, 1e-3, 2e-3, 1e-2})
        for (const double damping : {0.0, 1e-4, 1.0}) {
          const PendulumLaw law = weightless(inertia, damping);
          const TorsionSpring spring{stiffness, 0.1};
          PendulumState state{1, 0};
          const double before = energyOf(law, spring, state);
          for (int i = 0; i < 300; ++i) {
            state = advance(law, spring, state, 0, dt);
            ASSERT_LE(energyOf(law, spring, state), before * (1 + 1e-9)) << stiffness << ' ' << inertia << ' ' << dt;
          }
          ++cases;
        }
  EXPECT_EQ(cases, 10 * 13 * 5 * 3);
}

TEST(TorsionSpring, StaysBoundedWithAWeight) {
  for (const double share : {1e-3, 0.1, 0.5, 0.9, 0.999})  // of the spring in the square of the frequency
    for (const double damping : {0.0, 1e-3, 0.03, 2.0})
      for (double phase = 1e-3; phase <= kLargestSwing; phase *= support::kLong ? 1.19 : 1.9) {
        PendulumLaw law;
        law.gravity = 1 - share;
        law.damping = damping;
        const TorsionSpring spring{share, 0.2};
        PendulumState state{1, 0};
        const double before = energyOf(law, spring, state);
        for (int i = 0; i < 5000; ++i) {
          state = advance(law, spring, state, 0, phase);
          ASSERT_LE(energyOf(law, spring, state), before * 1.15) << share << ' ' << damping << ' ' << phase;
        }
      }
}

TEST(TorsionSpring, KeepsItsEnergyWithAWeightForAMillionTicks) {
  const PendulumLaw law;
  const TorsionSpring spring{40, 0.5};
  PendulumState state{-1, 0};
  const double before = energyOf(law, spring, state);
  double worst = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    state = advance(law, spring, state, 0, 1e-3);
    worst = std::fmax(worst, std::fabs(energyOf(law, spring, state) / before - 1));
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_LT(worst, 1e-5);
}

}  // namespace
}  // namespace hapticd::dynamics
