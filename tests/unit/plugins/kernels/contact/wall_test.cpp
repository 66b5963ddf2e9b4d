// SPDX-License-Identifier: MIT
#include "kernels/contact/wall.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::contact {
namespace {

constexpr double kDepths[] = {5e-324, 1e-300, 1e-20, 1e-12, 1e-6, 1e-4, 1e-3, 0.01, 1.0};

TEST(Wall, LinearWallIsASpringWhoseDampingGrowsWithDepth) {
  const WallLaw law{800, 5, 1, 1e-3};
  for (const double x : kDepths) {
    EXPECT_DOUBLE_EQ(wallForce(law, x, 0).force, 800 * x);
    EXPECT_NEAR(wallForce(law, x, 0.1).force, (800 + 5 * 0.1 / 1e-3) * x, 1e-15 * (1300 * x) + 5e-324);
    EXPECT_NEAR(wallForce(law, x, 0.1).damping, 5 * x / 1e-3, 1e-15 * 5e3 * x + 5e-324);
  }
}

TEST(Wall, EveryExponentGivesTheSameForceAtTheDepthOfItsScale) {
  for (const double n : {0.25, 0.5, 1.0, 1.5, 3.0}) {
    const WallLaw law{6000, 20, n, 1e-3};
    EXPECT_NEAR(wallForce(law, 1e-3, 0).force, 6, 1e-14) << n;
    EXPECT_NEAR(wallForce(law, 1e-3, 0.2).force, 6 + 20 * 0.2, 1e-14) << n;
    EXPECT_NEAR(wallForce(law, 1e-3, 0).stiffness, 6000 * n, 1e-9) << n;
  }
}

TEST(Wall, ForceGoesToZeroWithDepthAndStaysFinite) {
  for (const double n : {0.25, 0.5, 1.0, 1.5}) {
    const WallLaw law{6000, 50, n, 1e-3};
    double last = 0;
    for (const double x : kDepths) {
      const WallForce at = wallForce(law, x, 0.5);
      EXPECT_TRUE(std::isfinite(at.force));
      EXPECT_GE(at.force, last) << "grows with depth";
      EXPECT_GE(at.stiffness, 0);
      last = at.force;
    }
    EXPECT_LT(wallForce(law, 1e-300, 0.5).force, 1e-60) << n;
  }
}

TEST(Wall, RootLawKeepsItsDigitsAtTheSmallestDepths) {
  const WallLaw law{6000, 0, 0.5, 1e-3};
  for (const double x : {1e-290, 1e-20, 1e-12, 1e-6, 1e-4, 1e-3, 1.0})
    EXPECT_NEAR(wallForce(law, x, 0).force / (6 * std::sqrt(x / 1e-3)), 1, 1e-15) << x;
}

TEST(Wall, StiffnessAndDampingAreTheDerivativesOfTheForce) {
  for (const double n : {0.5, 1.0, 1.5})
    for (const double x : {1e-6, 1e-4, 2e-3})
      for (const double v : {-0.01, 0.0, 0.1}) {
        const WallLaw law{6000, 20, n, 1e-3};
        const double dx = 1e-5 * x, dv = 1e-5;
        const double slope = (wallForce(law, x + dx, v).force - wallForce(law, x - dx, v).force) / (2 * dx);
        const double drag = (wallForce(law, x, v + dv).force - wallForce(law, x, v - dv).force) / (2 * dv);
        EXPECT_NEAR(wallForce(law, x, v).stiffness, slope, 1e-8 * slope);
        EXPECT_NEAR(wallForce(law, x, v).damping, drag, 1e-8 * drag);
      }
}

TEST(Wall, NeverPullsAndPushesNothingOutside) {
  const WallLaw law{800, 50, 0.5, 1e-3};
  EXPECT_EQ(wallForce(law, 1e-3, -1).force, 0) << "it leaves faster than the damping lets it";
  for (const double x : {0.0, -0.0, -1e-9, -1.0, -double{INFINITY}, double{NAN}}) {
    EXPECT_EQ(wallForce(law, x, 10).force, 0);
    EXPECT_EQ(wallForce(law, x, 10).stiffness, 0);
    EXPECT_EQ(wallForce(law, x, 10).damping, 0);
  }
  EXPECT_EQ(wallForce(law, 1e-3, NAN).force, wallForce(law, 1e-3, 0).force) << "an unknown speed damps nothing";
}

TEST(Wall, EnergyIsTheIntegralOfTheForce) {
  for (const double n : {0.5, 1.0, 1.5}) {
    const WallLaw law{6000, 20, n, 1e-3};
    double sum = 0;
    constexpr int kSteps = 100'000;
    for (int i = 0; i < kSteps; ++i) sum += wallForce(law, (i + 0.5) * 2e-3 / kSteps, 0).force * 2e-3 / kSteps;
    EXPECT_NEAR(wallEnergy(law, 2e-3), sum, 1e-6 * sum) << n;
  }
  EXPECT_EQ(wallEnergy({}, -1), 0);
}

}  // namespace
}  // namespace hapticd::contact
