// SPDX-License-Identifier: MIT
/// Models that come, or are enabled, while a tip is in them.
#include <gtest/gtest.h>

#include "servo/core/core.hpp"
#include "test_world.hpp"

namespace hapticd::servo {
namespace {

/// A world that runs, and a model that comes into it.
struct Coming {
  explicit Coming(const std::string& plugin) {
    WorldOptions options;
    options.spare_models = 1;
    auto built = World::build(scene::Scene{}, options, quiet);
    world = std::move(*built);
    const scene::Model model = testModel(plugin);
    auto shape = world->prepare(model, quiet);
    state = Core::stateOf(**shape, model);
    world->store(0, std::move(*shape), model);
    Order order;
    order.kind = Order::Kind::kAdopt;
    order.model = &state;
    EXPECT_TRUE(world->core().apply(order, 0));
  }
  double forceAt(double y) { return tickOnce(*world, tick++, probeAt({0, y, 0})).y(); }
  double largestAt(double y, int ticks) {
    double largest = 0;
    for (int i = 0; i < ticks; ++i) largest = std::max(largest, forceAt(y));
    return largest;
  }
  void order(Order::Kind kind, uint32_t param) {
    Order order;
    order.kind = kind;
    order.param = param;
    EXPECT_TRUE(world->core().apply(order, tick * 1e-3));
  }

  static void quiet(int, const std::string&, const std::string&) {}
  std::unique_ptr<World> world;
  ModelState state;
  int tick = 0;
};

TEST(Entering, AModelThatComesAroundTheTipIsNotFeltUntilTheTipWasOutside) {
  Coming wall("wall");
  EXPECT_EQ(wall.largestAt(-0.016, 500), 0.0);
  EXPECT_TRUE(wall.world->core().models()[0].until_free);
  EXPECT_EQ(wall.largestAt(0.001, 60), 0.0);
  EXPECT_FALSE(wall.world->core().models()[0].until_free);
  EXPECT_EQ(wall.largestAt(0.001, 120), 0.0);
  EXPECT_DOUBLE_EQ(wall.largestAt(-0.001, 10), 1.0);
}

TEST(Entering, AModelThatWaitsSaysSoUntilItIsFelt) {
  Coming wall("wall");
  const ModelState& model = wall.world->core().models()[0];
  EXPECT_FALSE(model.waits) << "before it was looked at";
  wall.forceAt(-0.016);
  EXPECT_TRUE(model.waits);
  wall.largestAt(0.001, 40);
  EXPECT_TRUE(model.waits) << "outside, but for less than 50 ms";
  EXPECT_EQ(wall.largestAt(-0.016, 20), 0.0) << "so the next press is not felt";
  EXPECT_TRUE(model.waits);
  wall.largestAt(0.001, 60);
  EXPECT_FALSE(model.waits);
  EXPECT_GT(wall.forceAt(-0.001), 0.0);
}

TEST(Entering, ADisabledModelDoesNotWait) {
  Coming wall("wall");
  wall.forceAt(-0.016);
  wall.order(Order::Kind::kDisable, 0);
  wall.forceAt(-0.016);
  EXPECT_FALSE(wall.world->core().models()[0].waits);
}

TEST(Entering, AModelThatComesElsewhereIsFeltAtOnce) {
  Coming wall("wall");
  wall.largestAt(0.05, 120);
  EXPECT_DOUBLE_EQ(wall.forceAt(-0.001), 1.0);
}

TEST(Entering, AFieldWithoutASurfaceFadesInSlowly) {
  Coming field("turning");
  EXPECT_EQ(field.largestAt(0, 49), 0.0) << "before it was looked at for a while";
  double before = 0;
  for (int i = 0; i < 990; ++i) {
    const double force = field.forceAt(0);
    EXPECT_LE(force - before, 1.01e-3) << "in tick " << i;
    before = force;
  }
  EXPECT_NEAR(before, 0.989, 0.002);
  field.largestAt(0, 20);
  EXPECT_DOUBLE_EQ(field.forceAt(0), 1.0);
}

/// The hand goes along with a field of 1 N, faster than a field may lead a hand.
TEST(Entering, AModelThatIsNotFeltGivesNoEnergy) {
  for (const bool enabled : {true, false}) {
    Coming field("turning");
    field.world->core().serve({.max_force = {1}});
    field.largestAt(0, 2000);
    if (!enabled) field.order(Order::Kind::kDisable, 0), field.largestAt(0, 200);
    for (int i = 0; i < 3000; ++i) field.forceAt(1e-3 * i);
    const ShapeFault fault = field.world->core().models()[0].guard.fault();
    EXPECT_EQ(fault, enabled ? ShapeFault::kGives : ShapeFault::kNone);
  }
}

TEST(Entering, AModelThatIsEnabledAroundTheTipWaitsAsWell) {
  Coming wall("wall");
  wall.largestAt(0.05, 120);
  wall.order(Order::Kind::kDisable, 0);
  wall.largestAt(-0.016, 60);
  wall.order(Order::Kind::kEnable, Order::kOnceFree);
  EXPECT_EQ(wall.largestAt(-0.016, 200), 0.0);
  wall.largestAt(0.001, 120);
  EXPECT_DOUBLE_EQ(wall.forceAt(-0.001), 1.0);
}

TEST(Entering, AnOrderOfAnEarlierRecordingFadesInAsItDidThen) {
  Coming wall("wall");
  wall.largestAt(0.05, 120);
  wall.order(Order::Kind::kDisable, 0);
  wall.largestAt(-0.001, 60);
  wall.order(Order::Kind::kEnable, 0);
  EXPECT_DOUBLE_EQ(wall.largestAt(-0.001, 60), 1.0);
}

TEST(Entering, AModelThatLeavesFadesOutBeforeItIsGone) {
  Coming wall("wall");
  Core& core = wall.world->core();
  wall.largestAt(0.05, 120);
  double before = wall.forceAt(-0.001);
  ASSERT_DOUBLE_EQ(before, 1);
  wall.order(Order::Kind::kRelease, 0);
  uint32_t gone = 0;
  int ticks = 0;
  for (; !core.takeReleased(gone) && ticks < 1000; ++ticks) {
    const double force = wall.forceAt(-0.001);
    EXPECT_LE(before - force, 0.1) << "no step of a whole force, in tick " << ticks;
    before = force;
  }
  EXPECT_GT(ticks, 10);
  EXPECT_LT(ticks, 1000);
  EXPECT_LT(before, 0.1) << "it was hardly felt when it went";
  EXPECT_EQ(core.present(), 0u);
  EXPECT_EQ(wall.forceAt(-0.001), 0);
}

TEST(Entering, EnablingWhatIsFeltChangesNothing) {
  Coming wall("wall");
  wall.largestAt(0.05, 120);
  wall.forceAt(-0.001);
  wall.order(Order::Kind::kEnable, Order::kOnceFree);
  EXPECT_DOUBLE_EQ(wall.forceAt(-0.001), 1.0);
}

}  // namespace
}  // namespace hapticd::servo
