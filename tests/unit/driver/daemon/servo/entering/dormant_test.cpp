// SPDX-License-Identifier: MIT
/// Models that start disabled: nothing of them is computed until they are enabled.
#include <gtest/gtest.h>

#include <algorithm>

#include "servo/core/core.hpp"
#include "test_world.hpp"

namespace hapticd::servo {
namespace {

/// A world with a model that starts disabled.
struct Disabled {
  explicit Disabled(const std::string& plugin, bool kinematic = false, bool keep = true) {
    scene::Scene scene;
    scene.models.push_back(testModel(plugin));
    scene.models[0].enabled = false;
    scene.models[0].kinematic = kinematic;
    described = scene.models[0];
    auto built = World::build(scene, {.keep_disabled = keep}, [](int, const std::string&, const std::string&) {});
    world = std::move(*built);
  }
  double largestAt(double y, int ticks) {
    double largest = 0;
    for (int i = 0; i < ticks; ++i) largest = std::max(largest, tickOnce(*world, tick++, probeAt({0, y, 0})).y());
    return largest;
  }
  bool order(Order::Kind kind) {
    Order order;
    order.kind = kind;
    order.param = kind == Order::Kind::kEnable ? Order::kOnceFree : 0;
    return world->core().apply(order, tick * 1e-3);
  }
  scene::Model described;
  std::unique_ptr<World> world;
  int tick = 0;
};

TEST(Dormant, ItIsNotStepped) {
  Disabled wall("wall");
  EXPECT_EQ(wall.largestAt(-0.002, 20), 0.0);
  EXPECT_FALSE(wall.world->core().contact(0, 0).traced) << "a disabled model would be traced";
  EXPECT_TRUE(wall.world->core().live().empty());
  EXPECT_EQ(wall.world->core().transforms(), 0u);
  EXPECT_EQ(wall.world->core().present(), 1u);
}

TEST(Dormant, AfterItIsEnabledItWaitsForTheTipAndIsFelt) {
  Disabled wall("wall");
  wall.largestAt(-0.002, 20);
  EXPECT_TRUE(wall.order(Order::Kind::kEnable));
  EXPECT_EQ(wall.largestAt(-0.002, 500), 0.0) << "the tip is inside";
  EXPECT_TRUE(wall.world->core().contact(0, 0).traced);
  EXPECT_EQ(wall.largestAt(0.001, 120), 0.0);
  EXPECT_DOUBLE_EQ(wall.largestAt(-0.001, 10), 1.0);
}

TEST(Dormant, AfterItWasEnabledOnceADisabledModelIsTraced) {
  Disabled wall("wall");
  wall.order(Order::Kind::kEnable);
  wall.order(Order::Kind::kDisable);
  EXPECT_EQ(wall.largestAt(-0.002, 20), 0.0);
  EXPECT_TRUE(wall.world->core().contact(0, 0).traced);
}

TEST(Dormant, ABodyRestsUntilItIsEnabled) {
  Disabled body("sliding");
  body.largestAt(0, 20);
  EXPECT_EQ(body.world->core().models()[0].pose.position[0], 0.0);
  EXPECT_TRUE(body.world->core().live().empty());
  EXPECT_TRUE(body.order(Order::Kind::kEnable));
  body.largestAt(0, 1);
  EXPECT_DOUBLE_EQ(body.world->core().models()[0].pose.position[0], -1e-3);
}

TEST(Dormant, AKinematicModelMovesButIsNotStepped) {
  Disabled wall("wall", true);
  Order move;
  move.kind = Order::Kind::kMove;
  move.position[0] = 0.01;
  move.seconds = 0.1;
  ASSERT_TRUE(wall.world->core().apply(move, 0));
  wall.largestAt(-0.002, 300);
  EXPECT_DOUBLE_EQ(wall.world->core().models()[0].pose.position[0], 0.01);
  EXPECT_FALSE(wall.world->core().contact(0, 0).traced);
}

TEST(Dormant, TheSearchLooksForItOnlyAfterItWoke) {
  Disabled searched("searched");
  EXPECT_FALSE(searched.world->proximity().contains(0));
  EXPECT_TRUE(searched.world->wake(0, searched.described));
  EXPECT_TRUE(searched.world->proximity().contains(0));
  EXPECT_FALSE(searched.world->wake(0, searched.described)) << "it is awake";
  Disabled wall("wall");
  EXPECT_FALSE(wall.world->wake(0, wall.described)) << "its plugin finds the foot points";
}

TEST(Dormant, ItMayLeave) {
  Disabled wall("wall");
  EXPECT_TRUE(wall.order(Order::Kind::kRelease));
  wall.largestAt(-0.002, 2);
  uint32_t place = 7;
  EXPECT_TRUE(wall.world->core().takeReleased(place));
  EXPECT_EQ(place, 0u);
  EXPECT_FALSE(wall.order(Order::Kind::kEnable));
}

TEST(Dormant, ToolsThatJudgeAllModelsEnableIt) {
  Disabled wall("wall", false, false);
  EXPECT_DOUBLE_EQ(wall.largestAt(-0.001, 1), 1.0);
}

}  // namespace
}  // namespace hapticd::servo
