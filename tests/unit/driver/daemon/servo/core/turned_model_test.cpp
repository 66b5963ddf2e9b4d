// SPDX-License-Identifier: MIT
/// Models that turn, are turned or write a pose: velocity, orientation and force in their frames.
#include <utility>

#include "servo/core/core.hpp"
#include "test_world.hpp"

namespace hapticd::servo {
namespace {

TEST(TurnedModel, GivesShapesTheVelocityOfATurningSurface) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall", {number(1, HSP_REAL, 10)}));
  scene.models[0].kinematic = true;
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  scene.models[0].path = {{0, {}}, {1, {Vector3d::Zero(), turned}}};
  auto world = testWorld(scene);
  double before = 0;
  for (int i = 0; i <= 20; ++i) {  // the wall rises under a probe that rests 0.1 m from its axis
    tickOnce(*world, i, probeAt({0.1, 0, 0}));
    const double depth = world->core().contact(0, 0).world.depth_m, closing = (depth - before) / 1e-3;
    if (i > 1) {
      EXPECT_NEAR(world->core().force(0).norm(), 1000 * depth + 10 * closing, 1e-4) << i;
    }
    before = depth;
  }
  EXPECT_NEAR(before, 1e-3, 1e-6);
}

TEST(TurnedModel, GivesShapesTheOrientationOfTheProbeInTheModel) {
  scene::Scene scene;
  scene.models.push_back(testModel("aligning"));
  const Eigen::Quaterniond pose(0.8, 0.2, -0.4, 0.4);
  scene.models[0].pose.orientation = pose;
  auto world = testWorld(scene);
  constexpr double kSmall = 1e-3;  // [rad]
  for (int axis = -1; axis < 3; ++axis) {
    Vector3d turn = Vector3d::Zero();
    if (axis >= 0) turn[axis] = kSmall;
    Probe probe = probeAt({0, 0, 0});
    probe.orientation = pose * Eigen::Quaterniond(1, turn.x() / 2, turn.y() / 2, turn.z() / 2).normalized();
    tickOnce(*world, axis + 1, probe);
    EXPECT_LT((world->core().torque(0) + 2 * (pose * turn)).norm(), 1e-8) << axis;
  }
}

TEST(TurnedModel, SilencesABodyThatRunsAtTheHandWithItsBack) {
  for (const auto& [speed, fault] : {std::pair{30.0, ShapeFault::kRunsAway}, {-30.0, ShapeFault::kNone}}) {
    scene::Scene scene;
    scene.models.push_back(testModel("ramming", {number(0, HSP_REAL, speed)}));
    auto world = testWorld(scene);
    for (int i = 0; i <= 5; ++i) tickOnce(*world, i, probeAt({0, 0, 0}));
    EXPECT_EQ(world->core().models()[0].guard.fault(), fault) << speed;
  }
}

TEST(TurnedModel, MakesAQuaternionThatIsNearlyOfUnitLengthOne) {
  scene::Scene scene;
  scene.models.push_back(testModel("ramming", {number(1, HSP_REAL, 1 + 5e-4)}));
  auto world = testWorld(scene);
  EXPECT_DOUBLE_EQ(tickOnce(*world, 0, probeAt({0, 0, 0})).x(), 1);
  EXPECT_DOUBLE_EQ(world->core().models()[0].pose.orientation[0], 1);
  EXPECT_EQ(world->core().models()[0].guard.fault(), ShapeFault::kNone);
}

}  // namespace
}  // namespace hapticd::servo
