// SPDX-License-Identifier: MIT
/// The numbers of the claim that driver/docs/safety.md names, as numbers.
#include "claim_rig.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

TEST(Claim, OfNothingIsOneOfTwoThousandNewtonsAMetre) {
  Rested unclaimed;
  const Vector3d let = unclaimed.next(at({0, -1e-3, 0}, {0, 50, 0}));
  EXPECT_TRUE(unclaimed.held);
  EXPECT_NEAR(let.y(), 10 * 2000 * 1e-3 + 2, 1e-9);
}

/// A shape that moves itself with the probe: what it damps at is the speed that the probe has in the world, and 5 m/s
/// of its own.
TEST(Claim, DampingOfAShapeThatMovesItselfCountsTheSpeedOfTheProbe) {
  ClaimBounds bounds;
  bounds.stiffness = 1;
  bounds.damping = 1;
  bounds.moves_itself = true;
  ClaimStep step = at({0, 0, 0}, Vector3d::Zero());
  step.velocity = {8, 0, 0};
  Claim claim;
  bool held = false;
  claim.check(step, bounds, 0, held);
  step.p_world = {8e-3, 0, 0};
  step.force = {70, 0, 0};
  EXPECT_EQ(claim.check(step, bounds, kTick, held).x(), 70) << "10 times 1 N s/m at 8 m/s";
  EXPECT_FALSE(held);
}

}  // namespace
}  // namespace hapticd::servo
