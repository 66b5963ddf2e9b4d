// SPDX-License-Identifier: MIT
#include "kernels/contact/friction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hapticd::contact {
namespace {

using Eigen::Vector3d;

TEST(Friction, IsBoundedAndGivesBackNoMoreThanWasPutIn) {
  Friction friction;
  const FrictionLaw law{0.6, 0.3, 1000, 0};
  const Vector3d normal = Vector3d::UnitY();
  Vector3d last = Vector3d::Zero(), force = Vector3d::Zero();
  double work = 0;  // done by the hand
  for (int i = 0; i <= 200'000; ++i) {
    const double t = 1e-4 * i;
    const Vector3d foot(4e-3 * std::sin(t), 0, 3e-3 * std::sin(1.7 * t));
    const Vector3d next = friction.step(law, foot, normal, 2, Vector3d::Zero());
    work -= (force + next).dot(foot - last) / 2;
    force = next;
    last = foot;
    ASSERT_LE(force.norm(), 0.6 * 2 * (1 + 1e-12));
    ASSERT_GE(work, friction.energy(law) - 1e-6);
  }
  EXPECT_GT(work, 0.01);
}

TEST(Friction, PushesAlongTheSurfaceAloneAndGainsNothingWhenItTurns) {
  Friction friction;
  const FrictionLaw law{0.6, 0.3, 1000, 0};
  const Vector3d foot(0, 0, 0), beside(1e-3, 0, 0.5e-3);
  friction.step(law, foot, Vector3d::UnitY(), 2, Vector3d::Zero());
  friction.step(law, beside, Vector3d::UnitY(), 2, Vector3d::Zero());
  double energy = friction.energy(law);
  ASSERT_GT(energy, 1e-4);
  for (int i = 0; i <= 1000; ++i) {  // the probe stays, and the surface turns under it
    const double angle = 1e-3 * i;
    const Vector3d normal(std::sin(angle), std::cos(angle), 0);
    const Vector3d force = friction.step(law, beside, normal, 2, Vector3d::Zero());
    ASSERT_LT(std::abs(force.dot(normal)), 1e-12) << angle;
    ASSERT_LE(friction.energy(law), energy * (1 + 1e-12)) << angle;
    energy = friction.energy(law);
  }
}

TEST(Friction, HoldsWithTheStaticForceAgainOnceTheProbeSticks) {
  Friction friction;
  const FrictionLaw law{0.6, 0.3, 1000, 0};
  double at = 0;
  // Moves the probe by a distance in steps of 1 um, and returns the largest and the last force against it.
  const auto drag = [&](double distance) {
    double largest = 0, last = 0;
    for (int i = 0; i < static_cast<int>(std::abs(distance) * 1e6); ++i) {
      at += std::copysign(1e-6, distance);
      last = friction.step(law, {at, 0, 0}, Vector3d::UnitY(), 2, Vector3d::Zero()).norm();
      largest = std::max(largest, last);
    }
    return std::pair(largest, last);
  };
  for (int round = 0; round < 2; ++round) {
    const auto [largest, last] = drag(0.03);
    EXPECT_NEAR(largest, 0.6 * 2, 1e-2) << "it breaks away at the static limit";
    EXPECT_NEAR(last, 0.3 * 2, 1e-3) << "and slides at the dynamic one";
    drag(-0.6e-3);  // back to where the spring is relaxed: it sticks
  }
}

}  // namespace
}  // namespace hapticd::contact
