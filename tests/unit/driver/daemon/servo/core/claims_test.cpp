// SPDX-License-Identifier: MIT
/// What a shape claims holds for its torques, and while somebody sets its parameters.
#include <cmath>

#include "servo/core/core.hpp"
#include "test_world.hpp"

namespace hapticd::servo {
namespace {

/// A world of one model, under the law of now or under the former one.
struct Held {
  explicit Held(const scene::Model& model, bool former = false) {
    scene.models.push_back(model);
    WorldOptions options;
    options.former_claims = former;
    world = std::move(*World::build(scene, options, [](int, const std::string&, const std::string&) {}));
  }
  Vector3d tick(const Probe& probe = probeAt(Vector3d::Zero())) { return tickOnce(*world, ticks++, probe); }
  void set(double value, uint32_t param = 0) {
    Order order;
    order.kind = Order::Kind::kSet;
    order.param = param;
    order.value = value;
    ASSERT_TRUE(world->core().apply(order, ticks * 1e-3));
  }
  Vector3d torque() const { return world->core().torque(0); }
  ShapeFault trouble() const { return world->core().models()[0].guard.fault(); }
  scene::Scene scene;
  std::unique_ptr<World> world;
  int ticks = 0;
};

TEST(TorqueOfAShape, ThatKicksIsHeldBackAndThenSilenced) {
  for (const bool former : {false, true}) {
    Held kicks(testModel("turning", {number(0, HSP_REAL, 3)}), former);
    double most = 0;
    for (int i = 0; i < 200; ++i) {
      kicks.tick();
      most = std::max(most, kicks.torque().norm());
    }
    if (former) {
      EXPECT_EQ(most, 3) << "as it once was";
      EXPECT_EQ(kicks.trouble(), ShapeFault::kNone);
      continue;
    }
    EXPECT_LE(most, 0.25 + Claim::kHandle * Claim::kStep);
    EXPECT_EQ(kicks.torque().norm(), 0);
    EXPECT_EQ(kicks.trouble(), ShapeFault::kTwists);
  }
}

TEST(TorqueOfAShape, ThatNobodyCanFeelIsNotJudged) {
  Held kicks(testModel("turning", {number(0, HSP_REAL, 3)}));
  kicks.world->core().serve({.torque = false, .exchange = false});
  for (int i = 0; i < 200; ++i) EXPECT_EQ(kicks.tick().y(), 1);
  EXPECT_EQ(kicks.trouble(), ShapeFault::kNone);
}

/// A hand that twists by a radian, five times a second.
TEST(TorqueOfAShape, ThatFollowsTheHandIsLetThroughWhole) {
  Held aligns(testModel("aligning"));
  for (int i = 0; i < 1000; ++i) {
    Probe probe = probeAt(Vector3d::Zero());
    const double angle = std::sin(2 * M_PI * 5 * i * 1e-3);
    probe.orientation = Eigen::AngleAxisd(angle, Vector3d(2, -1, 2) / 3);
    aligns.tick(probe);
    EXPECT_NEAR(aligns.torque().norm(), 4 * std::abs(std::sin(angle / 2)), 1e-9) << i;
  }
  EXPECT_EQ(aligns.trouble(), ShapeFault::kNone);
}

TEST(LiveParameter, ThatIsSetInEveryTickOpensNoDoorForAKick) {
  for (const bool former : {false, true}) {
    Held kicks(testModel("obliging", {number(0, HSP_REAL, 8), number(1, HSP_BOOL, 1)}), former);
    int felt = 0;
    for (int i = 0; i < 1000; ++i) {
      kicks.set(7.5 + 0.5 * (i % 2));
      felt += kicks.tick().norm() > 4 ? 1 : 0;
    }
    if (former)
      EXPECT_EQ(felt, 1000) << "as it once was";
    else
      EXPECT_LE(felt, 1 + Claim::kAsked + Claim::kAskedPerSecond);
    for (int i = 0; i < 200; ++i) kicks.tick();
    EXPECT_EQ(kicks.trouble(), ShapeFault::kJump) << "as soon as nobody sets it any more";
  }
}

/// A program that lets a force swell by up to 500 N/s, in every tick; then it rests.
TEST(LiveParameter, ThatIsAnimatedSilencesNobody) {
  Held swells(testModel("obliging"));
  for (int i = 0; i < 2000; ++i) {
    const double wish = 4 - 4 * std::cos(2 * M_PI * 20 * i * 1e-3);
    swells.set(wish);
    ASSERT_LE(swells.tick().y(), wish + 1e-9) << i;
  }
  swells.set(8);
  for (int i = 0; i < 100; ++i) swells.tick();
  EXPECT_EQ(swells.tick().y(), 8);
  EXPECT_EQ(swells.trouble(), ShapeFault::kNone);
}

/// What a person sets by hand, a slider or a button, is felt at once.
TEST(LiveParameter, ThatIsSetNowAndThenIsFeltAtOnce) {
  Held rests(testModel("obliging"));
  for (int i = 0; i < 3000; ++i) {
    if (i % 600 == 300) rests.set(i / 600 % 2 == 0 ? 8 : 1);
    const double wish = i < 300 ? 0 : (i - 300) / 600 % 2 == 0 ? 8 : 1;
    ASSERT_EQ(rests.tick().y(), wish) << i;
  }
  EXPECT_EQ(rests.trouble(), ShapeFault::kNone);
}

TEST(LiveParameter, ThatNeedsNoConsentIsFeltSlowly) {
  constexpr uint32_t kWhim = 2;
  Held rests(testModel("obliging"));
  for (int i = 0; i < 300; ++i) rests.tick();
  rests.set(8, kWhim);
  EXPECT_NEAR(rests.tick().y(), Claim::kStep, 1e-9);
  for (int i = 0; i < 100; ++i) rests.tick();
  EXPECT_EQ(rests.tick().y(), 8);
  EXPECT_EQ(rests.trouble(), ShapeFault::kNone);
}

}  // namespace
}  // namespace hapticd::servo
