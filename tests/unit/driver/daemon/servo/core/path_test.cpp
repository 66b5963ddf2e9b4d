// SPDX-License-Identifier: MIT
#include "servo/core/path.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::servo {
namespace {

scene::PathPoint point(double t, double x, double angle) {
  return {t, {Eigen::Vector3d(x, 0, 0), Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()))}};
}

TEST(Path, InterpolatesPositionAndOrientation) {
  Path path({point(0, 0, 0), point(2, 1, 1)});
  hsp_pose pose{};
  path.at(0.5, pose);
  EXPECT_NEAR(pose.position[0], 0.25, 1e-15);
  EXPECT_NEAR(2 * std::atan2(pose.orientation[2], pose.orientation[0]), 0.25, 1e-14);
  EXPECT_NEAR(pose.linear[0], 0.5, 1e-15);
  EXPECT_NEAR(pose.angular[1], 0.5, 1e-14);
}

TEST(Path, RestsBeforeTheFirstAndAfterTheLastPoint) {
  Path path({point(1, 0.1, 0), point(2, 0.2, 1)});
  hsp_pose pose{};
  for (const double t : {0.0, 1.0, 2.0, 99.0}) {
    path.at(t, pose);
    EXPECT_EQ(pose.position[0], t < 1.5 ? 0.1 : 0.2);
    EXPECT_EQ(pose.linear[0], 0);
    EXPECT_EQ(pose.angular[1], 0);
  }
}

TEST(Path, GoesBackInTimeToo) {
  Path path({point(0, 0, 0), point(1, 1, 0), point(2, 4, 0)});
  hsp_pose pose{};
  path.at(1.5, pose);
  EXPECT_NEAR(pose.position[0], 2.5, 1e-15);
  path.at(0.5, pose);
  EXPECT_NEAR(pose.position[0], 0.5, 1e-15);
}

}  // namespace
}  // namespace hapticd::servo
