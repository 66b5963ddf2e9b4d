// SPDX-License-Identifier: MIT
#include "kernels/dynamics/contact_prediction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hapticd::dynamics {
namespace {

using Eigen::Vector3d;

constexpr double kPressStep = 1e-3, kPressWall = 1000, kPressDepth = 2e-3;

/// A probe that presses 2 mm deep along -z, and sticks.
LastContact pressed() {
  LastContact last;
  last.probe = Vector3d(0, 0, -kPressDepth);
  last.law = {kPressWall, 0, 1, 1e-3};
  last.depth = kPressDepth;
  last.along_limit = 0.5;
  last.along_stiffness = kPressWall;
  return last;
}

TEST(ContactPrediction, ARestingProbePressesWithTheForceOfTheWall) {
  const LastContact last = pressed();
  const PredictedContact press = predict(last, last.probe, 0, Vector3d::Zero(), kPressStep);
  EXPECT_LT((press.force - Vector3d(0, 0, -kPressWall * kPressDepth)).norm(), 1e-12);
  EXPECT_FALSE(press.lets_go);
}

TEST(ContactPrediction, AStuckProbeDragsTheBodyAlongUpToTheLimitOfItsFriction) {
  const LastContact last = pressed();
  const Vector3d side = Vector3d(0.6, 0.8, 0);
  for (const double slide : {1e-5, 1e-4, 4e-4, 1e-3, 1e-2, 1.0}) {
    const PredictedContact press = predict(last, last.probe + slide * side, 0, Vector3d::Zero(), kPressStep);
    const double drag = std::min(kPressWall * slide, last.along_limit);
    EXPECT_LT((press.force - Vector3d(0, 0, -kPressWall * kPressDepth) - drag * side).norm(), 1e-12) << slide;
  }
}

TEST(ContactPrediction, ABodyThatMovesWithTheProbeIsNotDragged) {
  const LastContact last = pressed();
  const Vector3d velocity(0.3, -0.1, 0);
  const PredictedContact press = predict(last, last.probe + kPressStep * velocity, 0, velocity, kPressStep);
  EXPECT_LT((press.force - Vector3d(0, 0, -kPressWall * kPressDepth)).norm(), 1e-12);
}

TEST(ContactPrediction, TheForceFallsByWhatItGivesWhenTheBodyMovesAway) {
  const LastContact last = pressed();
  const Vector3d away(0, 0, -0.1);  // m/s: within the step the body draws back by 0.1 mm
  const PredictedContact still = predict(last, last.probe, 0, Vector3d::Zero(), kPressStep);
  const PredictedContact moved = predict(last, last.probe, 0, away, kPressStep);
  EXPECT_LT((still.force - still.give * away - moved.force).norm(), 1e-12);
  EXPECT_LT(moved.force.norm(), still.force.norm());
}

}  // namespace
}  // namespace hapticd::dynamics
