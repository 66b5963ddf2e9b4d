// SPDX-License-Identifier: MIT
#include "kernels/contact/friction.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace hapticd::contact
