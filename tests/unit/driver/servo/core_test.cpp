#include "servo/core.hpp"

#include <cmath>
#include <limits>

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

TEST(Core, BadSampleGivesNoForceAndTheNextGoodOneIsFeltAgain) {
  scene::Scene scene;
  scene.models.push_back(testModel("wall"));
  auto world = testWorld(scene);
  const Probe good = probeAt({0, -0.001, 0});
  EXPECT_DOUBLE_EQ(tickOnce(*world, 0, good).y(), 1.0);
  Probe bad = probeAt({kNan, kNan, 1e300});
  bad.valid = false;
  EXPECT_EQ(tickOnce(*world, 1, bad), Vector3d::Zero());
  EXPECT_TRUE(world->core().wantsSearch());
  EXPECT_DOUBLE_EQ(tickOnce(*world, 2, good).y(), 1.0);
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
  EXPECT_EQ(world->core().models()[0].guard.trouble(), Trouble::kNone);
}

TEST(Core, NotANumberSilencesOnlyTheShapeThatAnsweredIt) {
  scene::Scene scene;
  scene.models.push_back(testModel("misbehaving"));
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
  EXPECT_TRUE(world->core().models()[0].guard.quarantined());
  EXPECT_FALSE(world->core().models()[1].guard.quarantined());
}

TEST(Core, UnknownStatusQuarantinesAndDegradedDoesNot) {
  for (const int how : {1, 3}) {
    scene::Scene scene;
    scene.models.push_back(testModel("misbehaving", {number(0, HSP_ENUM, how)}));
    auto world = testWorld(scene);
    for (int i = 0; i < 100; ++i) tickOnce(*world, i, probeAt({0, 0, 0}));
    EXPECT_EQ(world->core().models()[0].guard.quarantined(), how == 1);
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
      EXPECT_LE(std::abs(force - last), 1.0 / 20 + 1e-9) << "tick " << i;
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
  EXPECT_FALSE(world->core().wantsSearch());
  tickOnce(*world, 2, probeAt({0.13, 0, 0}));
  EXPECT_TRUE(world->core().wantsSearch());
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
