// SPDX-License-Identifier: MIT
#include "bounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "servo/safety/passivity/controller.hpp"
#include "support/sweep.hpp"
#include "wall_loop.hpp"

namespace hapticd::zwidth {
namespace {

constexpr double kTenPercent = 1.1;

TEST(QuantisedWall, MakesNoEnergyUpToTheBoundAndSomeTenPercentAbove) {
  const double devices[][4] = {// b, c, step, T
                               {0.5, 0.04, 20e-6, 1e-3}, {0.1, 0.04, 30e-6, 1e-3}, {0.5, 0.01, 100e-6, 1e-3},
                               {1.0, 0.04, 80e-6, 2e-3}, {0.5, 0.01, 30e-6, 1e-3}, {5.0, 0.5, 10e-6, 1.0 / 1500}};
  for (const auto& [b, c, step, period] : devices) {
    Body device;
    device.damping = b, device.friction = c;
    Wall wall;
    wall.resolution = step, wall.period = period;
    const double bound = maxStiffnessQuantised(wall, device);
    for (const double part : {0.1, 0.5, 0.9, 0.999}) {
      wall.stiffness = part * bound;
      EXPECT_GE(worstZigzagEnergy(wall, device), 0) << b << " " << c << " " << step << " at " << part;
    }
    wall.stiffness = kTenPercent * bound;
    EXPECT_LT(worstZigzagEnergy(wall, device), 0) << b << " " << c << " " << step;
  }
}

TEST(DampedWall, HasTheBoundOfTheClosedFormWithoutDelay) {
  for (int n : {1, 2, 3, 5, 15}) {
    Wall wall;
    wall.window = n, wall.damping = 0.5;
    Body device;
    device.damping = 1;
    const double k = maxStiffness(wall, device);
    EXPECT_NEAR(k * 1e-3 / 2 + windowCoefficient(n).value * 0.5, 1, 1e-6) << n;  // K T/2 + c_n B = b
  }
}

/// Least energy over all frequencies that the samples can hold.
double worstSinusoid(const Wall& wall, const Body& device) {
  double worst = 1e9;
  const int frequencies = support::kLong ? 160 : 40;
  for (int i = 1; i <= frequencies; ++i) worst = std::min(worst, sinusoidEnergy(wall, device, M_PI * i / frequencies));
  const double theta = windowCoefficient(wall.window).theta;
  return std::min(worst, sinusoidEnergy(wall, device, theta));
}

TEST(DampedWall, MakesNoEnergyUpToTheExactBoundAndSomeTenPercentAbove) {
  Body device;
  device.damping = 1;
  for (const int window : {1, 2, 3, 5, 15, 50})
    for (const int delay : {0, 1, 3})
      for (const double part : {0.0, 0.3, 0.8}) {
        Wall wall;
        wall.window = window, wall.delay = delay;
        wall.damping = part / (windowCoefficient(window).value * (1 + 2 * delay));
        const double bound = maxStiffness(wall, device);
        if (bound <= 0) continue;
        Wall below = wall, above = wall;
        below.stiffness = 0.99 * bound, below.damping *= 0.99;
        EXPECT_GE(worstSinusoid(below, device), 0) << window << " " << delay << " " << part;
        above.stiffness = kTenPercent * bound, above.damping *= kTenPercent;
        EXPECT_LT(worstSinusoid(above, device), 0) << window << " " << delay << " " << part;
      }
}

TEST(Hands, NoneMakesAWallBelowTheBoundGrowAndOneDoesTenPercentAbove) {
  Body device;
  device.damping = 1;
  const struct {
    int window, delay;
    double damping;
  } walls[] = {{1, 0, 0}, {1, 1, 0}, {1, 3, 0}, {5, 0, 0.5}, {5, 0, 1.5}, {15, 0, 1}, {15, 0, 3}};
  for (const auto& each : walls) {
    Wall wall;
    wall.window = each.window, wall.delay = each.delay, wall.damping = each.damping;
    const double bound = maxStiffness(wall, device);
    double below = 0, above = 0;
    for (double theta = 0.05; theta < 3.2; theta += 0.05)
      for (double load = 1e-3; load < 2e3; load *= 3) {
        Body body = device;
        body.mass = load * device.damping * wall.period;
        body.hand_spring = body.mass * std::pow(theta / wall.period, 2);
        for (const double scale : {0.999, kTenPercent}) {
          Wall scaled = wall;
          scaled.stiffness = scale * bound, scaled.damping = scale * each.damping;
          double& worst = scale < 1 ? below : above;
          worst = std::max(worst, spectralRadius(scaled, body));
        }
      }
    EXPECT_LT(below, 1) << each.window << " " << each.delay << " " << each.damping;
    EXPECT_GT(above, 1) << each.window << " " << each.delay << " " << each.damping;
  }
}

TEST(UndampedWall, ReturnsTheSpeedThatTheoryGivesWithinOnePercent) {
  for (const double rate : {500.0, 1000.0, 1500.0, 5000.0, 10000.0})
    for (const double mass : {0.075, 0.3, 4.0}) {
      Wall wall;
      wall.stiffness = 1500, wall.period = 1 / rate;
      const double theory = std::exp(M_PI * std::sqrt(wall.stiffness / mass) * wall.period / 4);
      EXPECT_NEAR(restitution(wall, mass) / theory, 1, 0.01) << rate << " Hz, " << mass << " kg";
    }
}

/// A mass that is pressed on a sampled spring wall by a steady force, with the controller or without.
struct Pressed {
  double stiffness, mass = 0.075, damping = 0.1, period = 1e-3;
  passivity::PassivityController book{1e-9, 0.1};  ///< observes; adds next to nothing

  /// Largest depth [m] of the last tenth of ten seconds; the observer's book goes on in `least`.
  double run(double& least) {
    double x = 1e-4, v = 0, deepest = 0;
    least = 0;
    for (int i = 0; i < 10000; ++i) {
      const double wall = x > 0 ? -stiffness * x : 0;
      const double given = book.update({x, 0, 0}, {wall, 0, 0}, period).x();
      least = std::min(least, book.energy());
      for (int k = 0; k < 50; ++k) {  // the same force, a fine step
        v += (given + 2.0 - damping * v) / mass * period / 50;
        x += v * period / 50;
      }
      if (i > 9000) deepest = std::max(deepest, std::abs(x));
    }
    return deepest;
  }
};

TEST(Observer, SeesAWallThatGrowsAndNoneThatSettles) {
  const double bound = 2 * 0.1 / 1e-3;
  double least = 0;
  Pressed settles{0.9 * bound};
  EXPECT_LT(settles.run(least), 1.5 * 2.0 / (0.9 * bound));
  EXPECT_GE(least, -1e-12) << "below the bound wall and device together never owe energy";
  Pressed grows{kTenPercent * bound};
  EXPECT_GT(grows.run(least), 1.5 * 2.0 / bound);
  EXPECT_LT(least, -1e-4);
}

}  // namespace
}  // namespace hapticd::zwidth
