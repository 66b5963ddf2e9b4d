// SPDX-License-Identifier: MIT
/// A model that a program outside leads: what the program writes, whatever it is, moves the model within its bounds.
#include <cmath>
#include <limits>
#include <random>

#include "servo/core/core.hpp"
#include "test_world.hpp"

namespace hapticd::servo {
namespace {

/// A wall on a path that stands still, led by a program.
struct Led {
  explicit Led(double damping = 0) {
    scene::Scene scene;
    scene.models.push_back(testModel("wall", {number(1, HSP_REAL, damping)}));
    scene.models[0].kinematic = true;
    scene.models[0].path = {{0, {}}};
    world = testWorld(scene);
    core().startAt(kEpoch);
    tick();
    EXPECT_TRUE(apply(Order::Kind::kLead));
  }
  Core& core() { return world->core(); }
  const ModelState& model() { return core().models()[0]; }
  double height() { return model().pose.position[1]; }
  bool apply(Order::Kind kind, double y = 0) {
    Order order;
    order.kind = kind;
    order.slot = &slot;
    order.position[1] = y;
    return core().apply(order, ticks * 1e-3);
  }
  Vector3d tick(const Vector3d& probe = {0, 1, 0}) { return tickOnce(*world, ticks++, probeAt(probe)); }
  /// CLOCK_MONOTONIC of the next tick.
  double now() const { return kEpoch + ticks * 1e-3; }

  static constexpr double kEpoch = 12345.678;
  link::PoseSlot slot;
  std::unique_ptr<World> world;
  int ticks = 0;
};

hapticd_target to(double y, double speed = 0, double time = 0) {
  hapticd_target target{};
  target.position[1] = y;
  target.orientation[0] = 1;
  target.linear[1] = speed;
  target.time = time;
  return target;
}

TEST(Lead, MovesTheModelAndGivesTheContactItsVelocity) {
  Led led(10);
  for (int i = 0; i < 500; ++i) {
    led.slot.put(to(i * 1e-4, 0.1, led.now()));
    led.tick();
  }
  EXPECT_NEAR(led.height(), 499e-4, 1e-6);
  EXPECT_NEAR(led.model().pose.linear[1], 0.1, 1e-6);
  const Vector3d force = led.tick({0, 0.049, 0});  // in a silent tick the twist goes on
  EXPECT_NEAR(force.y(), 1000 * 0.001 + 10 * 0.1, 1e-2);
}

TEST(Lead, TakesEachRecordOnceAndTellsTheTickThatTookIt) {
  Led led;
  EXPECT_EQ(led.model().lead.taken(), nullptr);
  led.slot.put(to(0.01));
  led.slot.put(to(0.02));  // newest wins
  led.tick();
  ASSERT_NE(led.model().lead.taken(), nullptr);
  EXPECT_EQ(led.model().lead.taken()->position[1], 0.02);
  led.tick();
  EXPECT_EQ(led.model().lead.taken(), nullptr);
}

TEST(Lead, GoesBeforeAMoveUntilItEnds) {
  Led led;
  led.slot.put(to(0.01));
  for (int i = 0; i < 500; ++i) led.tick();
  EXPECT_FALSE(led.apply(Order::Kind::kLead)) << "a second leader";
  EXPECT_FALSE(led.apply(Order::Kind::kMove, 0.05));
  EXPECT_TRUE(led.apply(Order::Kind::kUnlead));
  for (int i = 0; i < 200; ++i) led.tick();
  EXPECT_EQ(led.height(), 0.01) << "it stays where its leader left it, not on its path";
  EXPECT_TRUE(led.apply(Order::Kind::kMove, 0.05));
  for (int i = 0; i < 1000; ++i) led.tick();
  EXPECT_NEAR(led.height(), 0.05, 1e-12);
  EXPECT_TRUE(led.apply(Order::Kind::kLead));
  led.slot.put(to(0.02));
  for (int i = 0; i < 500; ++i) led.tick();
  EXPECT_NEAR(led.height(), 0.02, 1e-8);
}

TEST(Lead, OfAWriterThatDiedInsideKeepsTheLastRecord) {
  Led led;
  led.slot.put(to(0.01));
  for (int i = 0; i < 500; ++i) led.tick();
  auto* count = reinterpret_cast<uint64_t*>(&led.slot);
  *count += 1;
  count[3] = std::bit_cast<uint64_t>(5.0);  // half a record
  for (int i = 0; i < 500; ++i) led.tick();
  EXPECT_EQ(led.height(), 0.01);
  EXPECT_EQ(led.model().lead.refused(), 0u);
  led.slot.put(to(0.02));  // the next writer heals it
  for (int i = 0; i < 500; ++i) led.tick();
  EXPECT_EQ(led.height(), 0.02);
}

TEST(Lead, RefusesAndCountsWhatIsNoTarget) {
  Led led;
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  const hapticd_target bad[] = {to(kNotANumber), to(1e300), to(0, HUGE_VAL), to(0, 0, led.now() + 1000),
                                hapticd_target{}};
  for (const hapticd_target& target : bad) {
    led.slot.put(target);
    led.tick();
    EXPECT_EQ(led.model().lead.taken(), nullptr);
  }
  EXPECT_EQ(led.model().lead.refused(), std::size(bad));
  EXPECT_EQ(led.height(), 0);
}

/// Every byte of the memory may be anything at any time.
TEST(Lead, KeepsItsBoundsUnderAMillionFuzzedRecords) {
  Led led;
  std::mt19937_64 random(7);
  constexpr double kEdges[] = {0, 1, -1, 0.5, 9.99, 10.01, 1e300, 5e-324, HUGE_VAL, Led::kEpoch};
  hsp_pose last = led.model().pose;
  double fastest = 0, hardest = 0;
  uint64_t taken = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    hapticd_target target = to(0.1);
    auto* fields = reinterpret_cast<double*>(&target);
    for (uint64_t n = random() % 4; n > 0; --n) {
      const uint64_t kind = random() % 3, field = random() % 14;
      fields[field] = kind == 0   ? std::bit_cast<double>(random())
                      : kind == 1 ? kEdges[random() % std::size(kEdges)]
                                  : static_cast<double>(random() % 2000) * 0.01 - 10;
    }
    led.slot.put(target);
    if (random() % 8 == 0) reinterpret_cast<uint64_t*>(&led.slot)[0] = random();
    led.tick();
    const hsp_pose& pose = led.model().pose;
    taken += led.model().lead.taken() != nullptr;
    const Vector3d step = Vector3d(pose.position) - Vector3d(last.position);
    fastest = std::max(fastest, step.norm() / 1e-3);
    hardest = std::max(hardest, (Vector3d(pose.linear) - Vector3d(last.linear)).norm() / 1e-3);
    ASSERT_TRUE(Vector3d(pose.position).allFinite()) << i;
    last = pose;
  }
  EXPECT_LE(fastest, PoseFollower::kMostSpeed * 1.00001);
  EXPECT_LE(hardest, PoseFollower::kMostAcceleration * 1.00001);
  EXPECT_GT(taken, 100'000u) << "the bounds were put to the test";
  EXPECT_GT(led.model().lead.refused(), 100'000u);
}

}  // namespace
}  // namespace hapticd::servo
