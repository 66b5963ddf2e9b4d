// SPDX-License-Identifier: MIT
#include "servo/core/core.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "search_hook.hpp"
#include "test_world.hpp"

namespace hapticd::servo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Core, PushesAlongTheNormalOfATurnedModel) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall"));
  scene.models[0].pose.orientation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ());  // its y is the world's -x
  scene.models[0].pose.position = {0.1, 0, 0};
  auto world = testWorld(scene);
  const Vector3d force = tickOnce(*world, 0, probeAt({0.102, 0.3, -0.2}));  // 2 mm deep
  EXPECT_NEAR((force - Vector3d(-2, 0, 0)).norm(), 0, 1e-12);
  const Contact& contact = world->core().contact(0, 0);
  EXPECT_NEAR(contact.world.depth_m, 0.002, 1e-15);
  EXPECT_NEAR((Eigen::Map<const Vector3d>(contact.world.point) - Vector3d(0.1, 0.3, -0.2)).norm(), 0, 1e-15);
  EXPECT_NEAR((Eigen::Map<const Vector3d>(contact.world.normal) - Vector3d(-1, 0, 0)).norm(), 0, 1e-15);
}

TEST(Core, SumsTheForcesOfAllModels) {
  scene::Scene scene;
  for (int i = 0; i < 3; ++i) scene.models.push_back(testModel("wall"));
  auto world = testWorld(scene);
  EXPECT_DOUBLE_EQ(tickOnce(*world, 0, probeAt({0, -0.001, 0})).y(), 3.0);
}

TEST(Core, CountsOneTransformAModelAndTwoAFoot) {
  scene::Scene scene;
  for (int i = 0; i < 5; ++i) {
    scene.models.push_back(testModel("wall"));
    scene.models.back().pose.position.x() = 0.01 * i;
  }
  auto world = testWorld(scene);
  tickOnce(*world, 0, probeAt({0, -0.001, 0}));
  EXPECT_EQ(world->core().transforms(), 4u + 2u * 4u);  // the first stands at the world's origin
}

TEST(Core, ServesNoTorqueToArmsThatOnlyPush) {
  scene::Scene scene;
  scene.models.push_back(testModel("turning"));
  auto world = testWorld(scene);
  EXPECT_DOUBLE_EQ(tickOnce(*world, 0, probeAt({0, 0, 0})).y(), 1.0);
  EXPECT_DOUBLE_EQ(world->core().torque(0).x(), 0.25);
  world->core().serve({.torque = false, .exchange = false});
  EXPECT_DOUBLE_EQ(tickOnce(*world, 1, probeAt({0, 0, 0})).y(), 1.0);
  EXPECT_TRUE(world->core().torque(0).isZero(0));
  EXPECT_DOUBLE_EQ(world->core().contact(0, 0).world.torque[0], 0.0);
  EXPECT_DOUBLE_EQ(world->core().exchange(0).recoverable, 0.0);
}

/// A force that draws each of two hands by 0.3 m: each arm has an account of its own, and neither gets too much.
TEST(Core, AccountsForTheEnergyThatEachArmGets) {
  scene::Scene scene;
  scene.models.push_back(testModel("turning"));
  const WorldOptions options{.rate = scene.servo.rate, .probe_count = 2};
  auto world = World::build(scene, options, [](int, const std::string&, const std::string&) {});
  ASSERT_TRUE(world) << world.error();
  Core& core = (*world)->core();
  core.serve({.torque = false, .max_force = {1, 1}});
  for (int i = 0; i <= 300; ++i) {
    const Probe probe = probeAt({0, 1e-3 * i, 0});
    core.tick(i * 1e-3, i == 0 ? 0 : 1e-3, std::array{probe, probe});
    ASSERT_EQ(core.models()[0].guard.fault(), ShapeFault::kNone) << i;
  }
  EXPECT_DOUBLE_EQ(core.force(1).y(), 1.0);
}

TEST(Core, GivesShapesNoTimeBeforeTheStart) {
  scene::Scene scene;
  scene.models.push_back(testModel("clocked"));
  auto world = testWorld(scene);
  EXPECT_DOUBLE_EQ(tickOnce(*world, -500, probeAt({0, 0, 0})).y(), 0);  // 0.5 s before it, where a model settles
  EXPECT_DOUBLE_EQ(tickOnce(*world, 250, probeAt({0, 0, 0})).y(), 0.25);
}

TEST(Core, GivesShapesTheVelocityRelativeToTheModel) {
  scene::Scene scene;
  scene.models.push_back(testModel("sliding"));
  auto world = testWorld(scene);
  tickOnce(*world, 0, probeAt({0, 0, 0}, {2, 0, 0}));
  EXPECT_DOUBLE_EQ(tickOnce(*world, 1, probeAt({0, 0, 0}, {2, 0, 0})).x(), 3.0);
  EXPECT_DOUBLE_EQ(world->core().models()[0].pose.position[0], -1e-3);
}

TEST(Core, KinematicModelFollowsItsPathAndGivesItsVelocity) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall", {number(1, HSP_REAL, 10)}));
  scene.models[0].kinematic = true;
  scene.models[0].path = {{0, {}}, {1, {Vector3d(0, 0.1, 0), Eigen::Quaterniond::Identity()}}};
  auto world = testWorld(scene);
  for (int i = 0; i <= 500; ++i) tickOnce(*world, i, probeAt({0, 0.049, 0}));
  // The wall has risen to y = 0.05 at 0.1 m/s: 1 mm deep, closing at 0.1 m/s.
  EXPECT_NEAR(world->core().force(0).y(), 1000 * 0.001 + 10 * 0.1, 1e-9);
}

Order moveTo(double y, double seconds) {
  Order order;
  order.kind = Order::Kind::kMove;
  order.position[1] = y;
  order.seconds = seconds;
  return order;
}

/// Largest speed of a model between ticks of 1 ms, in m/s and rad/s.
struct Fastest {
  explicit Fastest(const ModelState& moved) : model(moved), last(moved.pose) {}
  void look() {
    const auto* q = model.pose.orientation;
    const Eigen::Quaterniond now(q[0], q[1], q[2], q[3]);
    const Eigen::Quaterniond before(last.orientation[0], last.orientation[1], last.orientation[2], last.orientation[3]);
    const Vector3d way = Eigen::Map<const Vector3d>(model.pose.position) - Eigen::Map<const Vector3d>(last.position);
    speed = std::max(speed, way.norm() / 1e-3);
    turn = std::max(turn, now.angularDistance(before) / 1e-3);
    last = model.pose;
  }
  const ModelState& model;
  hsp_pose last;
  double speed = 0, turn = 0;
};

TEST(Core, AMoveIsNeverFasterThanItMayBeWhereverTheModelIs) {
  for (const bool on_a_path : {false, true}) {
    scene::Scene scene;
    scene.models.push_back(testModel("wall"));
    scene.models[0].kinematic = true;
    scene.models[0].path = {{0, {}}};
    if (on_a_path) scene.models[0].path.push_back({1, {Vector3d(0, -0.9, 0), Eigen::Quaterniond::Identity()}});
    auto world = testWorld(scene);
    Core& core = world->core();
    int i = 0;
    for (; i < 500; ++i) tickOnce(*world, i, probeAt({0, 1, 0}));
    Fastest fastest(core.models()[0]);
    EXPECT_TRUE(core.apply(moveTo(3, 60), i * 1e-3));
    tickOnce(*world, i++, probeAt({0, 1, 0}));
    EXPECT_TRUE(core.apply(moveTo(3, 0.05), i * 1e-3)) << "where it is ordered to already, at once";
    fastest.last = core.models()[0].pose;
    EXPECT_GT(core.models()[0].glide.seconds(), 5);
    for (const int end = i + 8000; i < end; ++i) {
      tickOnce(*world, i, probeAt({0, 1, 0}));
      fastest.look();
    }
    EXPECT_LT(fastest.speed, 1.001) << on_a_path;
    EXPECT_NEAR(core.models()[0].pose.position[1], 3, 1e-12) << "it gets there all the same";
  }
}

TEST(Core, AMoveTurnsNoFasterThanHalfATurnASecond) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall"));
  scene.models[0].kinematic = true;
  scene.models[0].path = {{0, {}}};
  auto world = testWorld(scene);
  tickOnce(*world, 0, probeAt({0, 1, 0}));
  Fastest fastest(world->core().models()[0]);
  Order order = moveTo(0, 0.05);
  order.orientation[0] = 0, order.orientation[1] = 1;
  EXPECT_TRUE(world->core().apply(order, 1e-3));
  for (int i = 1; i < 2500; ++i) {
    tickOnce(*world, i, probeAt({0, 1, 0}));
    fastest.look();
  }
  EXPECT_LT(fastest.turn, M_PI * 1.001);
  EXPECT_NEAR(std::abs(world->core().models()[0].pose.orientation[1]), 1, 1e-12);
}

TEST(Core, AMoveWithoutAnOrientationKeepsTheOneThatTheModelHas) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall"));
  scene.models[0].kinematic = true;
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.5, Vector3d::UnitX()));
  scene.models[0].path = {{0, {Vector3d::Zero(), turned}}};
  auto world = testWorld(scene);
  tickOnce(*world, 0, probeAt({0, 1, 0}));
  Order order = moveTo(0.01, 0);
  order.orientation[0] = 0;
  EXPECT_TRUE(world->core().apply(order, 1e-3));
  for (int i = 1; i < 600; ++i) tickOnce(*world, i, probeAt({0, 1, 0}));
  EXPECT_NEAR(world->core().models()[0].pose.orientation[1], turned.x(), 1e-12);
  EXPECT_NEAR(world->core().models()[0].pose.position[1], 0.01, 1e-12);
}

Order setFirstParameter(double value) {
  Order order;
  order.kind = Order::Kind::kSet;
  order.value = value;
  return order;
}

TEST(Core, AStiffnessThatWasAskedForIsNoJumpOfThePlugin) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall", {number(0, HSP_REAL, 800)}));
  auto world = testWorld(scene);
  for (int i = 0; i < 1000; ++i) {  // a hand that trembles, 5 mm deep
    const double depth = 0.005 + 2e-4 * std::sin(0.3 * i);
    if (i == 300) world->core().apply(setFirstParameter(30000), i * 1e-3);
    const Vector3d force = tickOnce(*world, i, probeAt({0, -depth, 0}));
    EXPECT_NEAR(force.y(), depth * (i < 300 ? 800 : 30000), 1e-9) << i;
  }
  EXPECT_EQ(world->core().models()[0].guard.fault(), ShapeFault::kNone);
}

TEST(Core, BadSampleGivesNoForceAndTheNextGoodOneIsFeltAgain) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall"));
  auto world = testWorld(scene);
  const Probe good = probeAt({0, -0.001, 0});
  EXPECT_DOUBLE_EQ(tickOnce(*world, 0, good).y(), 1.0);
  Probe bad = probeAt({kNan, kNan, 1e300});
  bad.valid = false;
  EXPECT_EQ(tickOnce(*world, 1, bad), Vector3d::Zero());
  EXPECT_TRUE(world->core().needsSearch());
  EXPECT_DOUBLE_EQ(tickOnce(*world, 2, good).y(), 1.0);
}

TEST(Core, ABadSampleEndsTheForceOfAShapeThatPushesAllTheSame) {
  scene::Scene scene;
  scene.models.push_back(testModel("turning"));
  auto world = testWorld(scene);
  Probe probe = probeAt({0, 0, 0});
  EXPECT_DOUBLE_EQ(tickOnce(*world, 0, probe).y(), 1.0);
  probe.valid = false;
  EXPECT_EQ(tickOnce(*world, 1, probe), Vector3d::Zero());
  EXPECT_EQ(world->core().torque(0), Vector3d::Zero());
}

TEST(Core, ADampedWallMayPushAsHardAsItsDampingSays) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall", {number(0, HSP_REAL, 1000), number(1, HSP_REAL, 500)}));
  auto world = testWorld(scene);
  for (int i = 0; i < 50; ++i) {  // from 5 mm above to 20 mm below, at 0.5 m/s, which ends at once
    const double y = 0.005 - 0.0005 * i, v = i < 40 ? -0.5 : 0;
    const Vector3d force = tickOnce(*world, i, probeAt({0, y, 0}, {0, v, 0}));
    EXPECT_NEAR(force.y(), y < 0 ? -1000 * y - 500 * v : 0, 1e-9) << i;
  }
  EXPECT_EQ(world->core().models()[0].guard.fault(), ShapeFault::kNone);
}

/// What has no length as a number of the machine is no number either.
class NoNumber : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(NotANumberAndTooLarge, NoNumber, testing::Values(0, 4));

TEST_P(NoNumber, SilencesOnlyTheShapeThatAnsweredIt) {
  scene::Scene scene;
  scene.models.push_back(testModel("misbehaving", {number(0, HSP_ENUM, GetParam())}));
  scene.models.push_back(testModel("wall"));
  auto world = testWorld(scene);
  double last = 0;
  for (int i = 0; i < 100; ++i) {
    const Vector3d force = tickOnce(*world, i, probeAt({0, -0.001, 0}));
    ASSERT_TRUE(force.allFinite());
    if (i == 9) {
      EXPECT_DOUBLE_EQ(force.y(), 2.0);
    }
    if (i > 10) {
      EXPECT_LE(force.y(), last) << "a faded force may only fall";
    }
    if (i >= 10 + 21) {
      EXPECT_DOUBLE_EQ(force.y(), 1.0) << "the wall goes on alone within 20 ms";
    }
    last = force.y();
  }
  EXPECT_TRUE(world->core().models()[0].guard.silenced());
  EXPECT_FALSE(world->core().models()[1].guard.silenced());
}

TEST(Core, UnknownStatusQuarantinesAndDegradedDoesNot) {
  for (const int how : {1, 3}) {
    scene::Scene scene;
    scene.models.push_back(testModel("misbehaving", {number(0, HSP_ENUM, how)}));
    auto world = testWorld(scene);
    for (int i = 0; i < 100; ++i) tickOnce(*world, i, probeAt({0, 0, 0}));
    EXPECT_EQ(world->core().models()[0].guard.silenced(), how == 1);
    EXPECT_DOUBLE_EQ(world->core().force(0).y(), how == 1 ? 0.0 : 1.0);
  }
}

TEST(Core, LostTrackFadesOutAndComesBackWithoutAKick) {
  scene::Scene scene;
  scene.models.push_back(testModel("misbehaving", {number(0, HSP_ENUM, 2), number(2, HSP_INT, 30)}));
  auto world = testWorld(scene);
  double last = 0;
  for (int i = 0; i < 200; ++i) {
    const double force = tickOnce(*world, i, probeAt({0, 0, 0})).y();
    if (i > 0) {
      EXPECT_LE(last - force, 1.0 / 2 + 1e-9) << "tick " << i;
      EXPECT_LE(force - last, 1.0 / 50 + 1e-9) << "tick " << i;
    }
    if (i == 35) {
      EXPECT_DOUBLE_EQ(force, 0.0);
    }
    last = force;
  }
  EXPECT_DOUBLE_EQ(last, 1.0);
}

TEST(Core, JumpAsksForASearchInTheNextTick) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall"));
  auto world = testWorld(scene);
  tickOnce(*world, 0, probeAt({0, 0, 0}));
  tickOnce(*world, 1, probeAt({0.01, 0, 0}));
  EXPECT_FALSE(world->core().needsSearch());
  tickOnce(*world, 2, probeAt({0.13, 0, 0}));
  EXPECT_TRUE(world->core().needsSearch());
}

/// Nobody knows which way the probe went meanwhile, and a sheet between both places was perhaps not crossed.
TEST(Core, ALongGapIsAJumpOfARunAndNoneOfATool) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall"));
  for (const bool run : {false, true})
    for (const double gap : {0.09, 0.11}) {
      WorldOptions options;
      options.gaps_jump = run;
      auto world = World::build(scene, options, [](int, const std::string&, const std::string&) {});
      ASSERT_TRUE(world);
      const Probe probe = probeAt({0, 0.01, 0});
      for (int i = 0; i < 3; ++i) tickOnce(**world, i, probe);
      ASSERT_FALSE((*world)->core().needsSearch());
      (*world)->core().tick(2e-3 + gap, gap, {&probe, 1});
      EXPECT_EQ((*world)->core().needsSearch(), run && gap > 0.1) << gap;
    }
}

/// Looks on while models are searched, as a tick of the servo could at that moment.
struct OnLooker {
  link::Link& link;
  int looks = 0;
  size_t seen = 0;  ///< records of the search that were visible before it had ended
  size_t take() {
    link::ActivationRecord record;
    size_t taken = 0;
    while (link.records.pop(record)) ++taken;
    return taken;
  }
  static void look(void* self) {
    auto& looker = *static_cast<OnLooker*>(self);
    ++looker.looks;
    looker.seen += looker.take();
  }
};

/// A tick that took half of a search would take the other half for one that began later, see Tracks::noteSearch().
TEST(Proximity, ShowsTheServoAllRecordsOfASearchAtOnce) {
  scene::Scene scene;
  for (int i = 0; i < 4; ++i) scene.models.push_back(testModel("searched"));
  auto world = testWorld(scene);
  OnLooker looker{world->link()};
  for (const auto& shape : world->shapes()) {
    const void* hook = shape->description().extension(shape->handle(), kSearchHook);
    *static_cast<SearchHook*>(const_cast<void*>(hook)) = {&OnLooker::look, &looker};
  }
  const Probe probe = probeAt({0, 0, 0});
  world->core().publish(0, {&probe, 1});
  for (int search = 1; search <= 2; ++search) {  // the first starts surfaces, the second offers feet on them
    world->proximity().search();
    EXPECT_EQ(looker.looks, 4 * search) << "one look at each model";
    EXPECT_EQ(looker.seen, 0u) << "the search had not ended yet";
    EXPECT_EQ(looker.take(), 12u) << "three surfaces of each model";
  }
}

TEST(World, PluginThatThrowsAnythingIsAnErrorThatNamesTheModel) {
  scene::Scene scene;
  scene.models.push_back(testModel("throwing"));
  const auto world = World::build(scene, {1000, 1}, [](int, const std::string&, const std::string&) {});
  ASSERT_FALSE(world);
  EXPECT_NE(world.error().find("'throwing'"), std::string::npos) << world.error();
}

TEST(Core, SameInputGivesTheSameBits) {
  scene::Scene scene;
  for (const char* plugin : {"wall", "sliding"}) scene.models.push_back(testModel(plugin));
  auto a = testWorld(scene), b = testWorld(scene);
  for (int i = 0; i < 1000; ++i) {
    const Probe probe = probeAt({std::sin(i * 0.01), 0.01 * std::cos(i * 0.03), 0.1}, {0.1, std::sin(i * 0.2), 0});
    EXPECT_EQ(tickOnce(*a, i, probe), tickOnce(*b, i, probe));
  }
}

}  // namespace
}  // namespace hapticd::servo
