// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "servo/safety/claim.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

hsp_contact contact(double force, double depth) {
  hsp_contact c{};
  c.flags = HSP_OUT_TRACED | (depth > 0 ? HSP_OUT_CONTACT : 0);
  c.force[1] = force;
  c.point[1] = 0;
  c.normal[1] = 1;
  c.depth_m = depth;
  return c;
}

TEST(PullsIn, IsSaidOfAForceAwayFromTheFootInsideAndTowardItOutside) {
  const Vector3d inside(0, -1e-3, 0), outside(0, 1e-3, 0);
  EXPECT_TRUE(pullsIn(contact(-1, 1e-3), inside));
  EXPECT_FALSE(pullsIn(contact(1, 1e-3), inside));
  EXPECT_FALSE(pullsIn(contact(0, 1e-3), inside));
  EXPECT_TRUE(pullsIn(contact(-1, -1e-3), outside));
  EXPECT_FALSE(pullsIn(contact(1, -1e-3), outside));
}

TEST(PullsIn, IsNotSaidOfRoundingNorOfWhatIsNotTraced) {
  const Vector3d inside(0, -1e-3, 0);
  hsp_contact aside = contact(0, 1e-3);
  aside.force[0] = 5;
  aside.force[1] = -0.049;  // a hundredth of it
  EXPECT_FALSE(pullsIn(aside, inside));
  aside.force[1] = -0.06;
  EXPECT_TRUE(pullsIn(aside, inside));
  EXPECT_FALSE(pullsIn(contact(-0.0099, 1e-3), inside)) << "too small to be felt";
  EXPECT_TRUE(pullsIn(contact(-0.011, 1e-3), inside));
  EXPECT_FALSE(pullsIn(contact(-1, 0.9e-6), {0, -0.9e-6, 0})) << "too near for a direction";
  EXPECT_TRUE(pullsIn(contact(-1, 1.1e-6), {0, -1.1e-6, 0}));
  hsp_contact untraced = contact(-1, 1e-3);
  untraced.flags = 0;
  EXPECT_FALSE(pullsIn(untraced, inside));
}

TEST(PullsIn, IsNotSaidAtItsBoundsAndTakesAFootAtNoDepthForOneOutside) {
  const Vector3d inside(0, -1e-3, 0), outside(0, 1e-3, 0);
  EXPECT_FALSE(pullsIn(contact(-0.01, 1e-3), inside));
  EXPECT_FALSE(pullsIn(contact(-1, 1e-6), {0, -1e-6, 0}));
  hsp_contact slanted = contact(-0.01, 1);
  slanted.force[0] = std::sqrt(1 - 1e-4);
  ASSERT_EQ(std::sqrt(slanted.force[0] * slanted.force[0] + 1e-4), 1);
  EXPECT_FALSE(pullsIn(slanted, {0, -1, 0}));
  EXPECT_FALSE(pullsIn(contact(1, 0), outside));
  EXPECT_TRUE(pullsIn(contact(-1, 0), outside));
}

}  // namespace
}  // namespace hapticd::servo
