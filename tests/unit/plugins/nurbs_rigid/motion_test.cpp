// SPDX-License-Identifier: MIT
#include "nurbs_rigid/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../plugin_under_test.hpp"
#include "traced_shape/model_file.hpp"

namespace hapticd::test {
namespace {

constexpr double kDynamic = 2;  // of the choices of `motion`
constexpr double kHinge = 1, kSlider = 2;
const Vector3d kFar(0, 0, 10);  // a probe that touches nothing

/// A cube of 100 mm about the origin that moves.
void makeCube(PluginUnderTest& plugin, double mass) {
  ASSERT_EQ(plugin.set("geometry", kModels + "box.yaml"), HSP_OK);
  ASSERT_EQ(plugin.set("motion", kDynamic), HSP_OK);
  ASSERT_EQ(plugin.set("mass", mass), HSP_OK);
}

dynamics::MassProperties propertiesOf(const std::string& name, bool& bounded) {
  ModelFile file = readModelFile(kModels + name);
  trace::ModelOptions options;
  options.edges = std::move(file.edges);
  return massProperties(trace::Model(file.surfaces, options), bounded);
}

TEST(Motion, CentreAndInertiaOfASolidAreThoseOfTheTextbook) {
  bool bounded = false;
  const auto cube = propertiesOf("box.yaml", bounded);
  EXPECT_TRUE(bounded);
  EXPECT_LT(cube.center.norm(), 1e-15);
  EXPECT_LT((cube.inertia - Eigen::Matrix3d::Identity() * 0.01 / 6).norm(), 1e-15);
  const auto ball = propertiesOf("sphere.yaml", bounded);
  EXPECT_TRUE(bounded);
  EXPECT_LT(ball.center.norm(), 1e-10);
  EXPECT_LT((ball.inertia - Eigen::Matrix3d::Identity() * 0.4 * 0.0025).norm(), 1e-6 * 1e-3);
}

TEST(Motion, ASurfaceThatBoundsNoVolumeTakesTheBoxAroundIt) {
  ModelFile file = readModelFile(kModels + "box.yaml");
  file.surfaces.resize(1);  // the right side alone: a square of 100 mm
  bool bounded = true;
  const auto plate = massProperties(trace::Model(file.surfaces, {}), bounded);
  EXPECT_FALSE(bounded);
  EXPECT_LT((plate.center - Vector3d(0.05, 0, 0)).norm(), 1e-12);
  EXPECT_NEAR(plate.inertia(0, 0), 0.01 / 6, 1e-5);
  EXPECT_GT(dynamics::principalMoments(plate.inertia).minCoeff(), 0);
}

TEST(Motion, StaticAndKinematicModelsIntegrateNothing) {
  for (const double motion : {0.0, 1.0}) {
    PluginUnderTest plugin;
    makeCube(plugin, 1);
    plugin.set("motion", motion);
    ASSERT_EQ(plugin.activate(), HSP_OK);
    EXPECT_EQ(plugin.report.flags & HSP_R_MOVES, 0u);
    for (int i = 0; i < 100; ++i) plugin.tick({{0, 0.049, 0}});
    EXPECT_EQ(plugin.position(), Vector3d::Zero());
  }
  EXPECT_NE(PluginUnderTest::kind().flags & HSP_C_MOVES, 0u);
}

TEST(Motion, FallsUnlessItHasNoWeight) {
  for (const double gravity : {0.0, 1.0}) {
    PluginUnderTest plugin;
    makeCube(plugin, 3);
    plugin.set("gravity", gravity);
    plugin.set("velocity", {0.5, 0, 0});
    ASSERT_EQ(plugin.activate(), HSP_OK);
    EXPECT_NE(plugin.report.flags & HSP_R_MOVES, 0u);
    plugin.tick({kFar});
    EXPECT_EQ(plugin.position(), Vector3d::Zero()) << "the first step has no time";
    for (int i = 0; i < 1000; ++i) plugin.tick({kFar});
    EXPECT_LT((plugin.position() - Vector3d(0.5, -gravity * 9.81 / 2, 0)).norm(), 1e-11);
    EXPECT_NEAR(plugin.pose.linear[1], -gravity * 9.81, 1e-11);
  }
}

TEST(Motion, WhatTheProbeFeelsTheBodyGetsAsMomentum) {
  for (const double mass : {0.05, 1.0, 40.0}) {
    PluginUnderTest plugin;
    makeCube(plugin, mass);
    plugin.set("stiffness", 1000);
    plugin.set("gravity", 0);
    ASSERT_EQ(plugin.activate(), HSP_OK);
    Vector3d impulse = Vector3d::Zero(), turning = Vector3d::Zero();
    for (int i = 0; i < 400; ++i) {
      const Vector3d probe(0.02, 0.052 - 1e-5 * i, 0.01);
      plugin.tick({probe});
      impulse -= 1e-3 * plugin.force();
      turning -= 1e-3 * (probe - plugin.position()).cross(plugin.force());
    }
    ASSERT_GT(impulse.norm(), 1e-3 * mass);
    EXPECT_LT((mass * Vector3d(plugin.pose.linear) - impulse).norm(), 0.03 * impulse.norm()) << mass;
    EXPECT_LT((mass * 0.01 / 6 * Vector3d(plugin.pose.angular) - turning).norm(), 0.03 * turning.norm()) << mass;
  }
}

TEST(Motion, APoseAndItsVelocitiesBelongTogether) {
  PluginUnderTest plugin;
  makeCube(plugin, 0.5);
  plugin.set("center", {0.02, -0.01, 0.03});
  plugin.set("inertia", {1e-3, 2e-3, 2.5e-3});
  plugin.set("spin", {3, -2, 1});
  plugin.set("velocity", {0.2, 0, 0.1});
  ASSERT_EQ(plugin.activate(), HSP_OK);
  plugin.tick({kFar});
  for (int i = 0; i < 200; ++i) {
    const hsp_pose before = plugin.pose;
    plugin.tick({kFar});
    const hsp_pose& now = plugin.pose;
    const Eigen::Quaterniond q0(before.orientation[0], before.orientation[1], before.orientation[2],
                                before.orientation[3]);
    const Eigen::Quaterniond q1(now.orientation[0], now.orientation[1], now.orientation[2], now.orientation[3]);
    const Vector3d turn = 2 * (q1 * q0.conjugate()).vec() / 1e-3;
    const Vector3d way = (Vector3d(now.position) - Vector3d(before.position)) / 1e-3;
    EXPECT_LT((turn - (Vector3d(before.angular) + Vector3d(now.angular)) / 2).norm(), 1e-4);
    EXPECT_LT((way - (Vector3d(before.linear) + Vector3d(now.linear)) / 2).norm(), 1e-4);
    EXPECT_NEAR(q1.norm(), 1, 1e-14);
  }
}

TEST(Motion, ATetherBringsItBack) {
  PluginUnderTest plugin;
  makeCube(plugin, 2);
  plugin.set("gravity", 0);
  plugin.set("tether", 50);
  plugin.set("drag", 20);
  plugin.set("velocity", {0, 1, 0});
  ASSERT_EQ(plugin.activate(), HSP_OK);
  double farthest = 0;
  for (int i = 0; i < 8000; ++i) {
    plugin.tick({kFar});
    farthest = std::fmax(farthest, plugin.position().norm());
  }
  EXPECT_GT(farthest, 0.05);
  EXPECT_LT(plugin.position().norm(), 1e-9);
}

TEST(Motion, ADoorTurnsAboutItsHingeWhenPushed) {
  PluginUnderTest plugin;
  makeCube(plugin, 1);
  plugin.set("joint", kHinge);
  plugin.set("pivot", {-0.05, 0, 0});
  plugin.set("axis", {0, 1, 0});
  plugin.set("angular_drag", 0.01);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  for (int i = 0; i < 1000; ++i) plugin.tick({{0.03, 0.01, 0.052 - 2e-5 * i}});
  EXPECT_GT(plugin.pose.orientation[2], 0.05) << "pushed along -z at its free end: it turns about +y";
  const double* q = plugin.pose.orientation;
  const Vector3d pivot = plugin.position() + Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * Vector3d(-0.05, 0, 0);
  EXPECT_LT((pivot - Vector3d(-0.05, 0, 0)).norm(), 1e-15);
}

TEST(Motion, ADrawerSlidesAlongItsAxisOnly) {
  PluginUnderTest plugin;
  makeCube(plugin, 1);
  plugin.set("joint", kSlider);
  plugin.set("axis", {1, 0, 0});
  plugin.set("stiffness", 2000);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  for (int i = 0; i < 1000; ++i) plugin.tick({{-0.051 + 2e-5 * i, 0.03, 0.02}});
  EXPECT_GT(plugin.position().x(), 0.01);
  EXPECT_EQ(plugin.position().y(), 0);
  EXPECT_EQ(plugin.pose.orientation[0], 1);
}

TEST(Motion, ABodyOfAnyMassIsHeldQuietlyBetweenTwoFingers) {
  for (double mass = 1e-6; mass < 2e3; mass *= 10)
    for (const double exponent : {0.5, 1.0}) {
      PluginUnderTest plugin;
      makeCube(plugin, mass);
      plugin.set("stiffness", 6000);
      plugin.set("damping", 20);
      plugin.set("exponent", exponent);
      plugin.set("gravity", 0);
      plugin.set("drag", mass);
      plugin.set("velocity", {0, 0.02, 0});
      ASSERT_EQ(plugin.activate(2, 1500), HSP_OK);
      double late = 0;
      for (int i = 0; i < 6000; ++i) {
        plugin.tick({{0, 0.049, 0}, {0, -0.049, 0}});
        ASSERT_EQ(plugin.status, HSP_OK);
        ASSERT_TRUE(plugin.position().allFinite());
        ASSERT_LT(plugin.position().norm(), 1e-2) << mass << ' ' << exponent << ' ' << i;
        if (i > 5000) late = std::fmax(late, std::fabs(plugin.pose.linear[1]));
      }
      EXPECT_LT(late, 0.021) << "mass " << mass << ", n " << exponent;
    }
}

TEST(Motion, FrictionDragsABodyAlong) {
  for (const double mass : {1e-5, 1.0}) {
    PluginUnderTest plugin;
    makeCube(plugin, mass);
    plugin.set("friction_static", 0.8);
    plugin.set("friction_dynamic", 0.6);
    plugin.set("gravity", 0);
    plugin.set("joint", kSlider);
    plugin.set("axis", {1, 0, 0});
    ASSERT_EQ(plugin.activate(), HSP_OK);
    double x = 0;
    for (int i = 0; i < 3000; ++i) {
      x += 1e-5;  // 10 mm/s
      plugin.tick({{x, 0.049, 0}});
    }
    EXPECT_NEAR(plugin.position().x(), x, 2e-3) << mass;
    EXPECT_LT(std::fabs(plugin.pose.linear[0]), 0.05) << mass;
  }
}

TEST(Motion, AResetForgetsTheHandAndAJumpIsNoPush) {
  for (const bool jump : {false, true}) {
    PluginUnderTest plugin;
    makeCube(plugin, 1);
    plugin.set("gravity", 0);
    ASSERT_EQ(plugin.activate(), HSP_OK);
    plugin.tick({{0, 0.045, 0}});
    EXPECT_GT(plugin.force().y(), 1);
    if (!jump) plugin.reset();
    plugin.tick({kFar}, {}, jump ? uint32_t{HSP_IN_JUMP} : 0u);
    EXPECT_EQ(plugin.position(), Vector3d::Zero());
    EXPECT_EQ(plugin.pose.linear[1], 0);
  }
}

TEST(Motion, ANanSampleNeitherPushesNorStopsIt) {
  PluginUnderTest plugin;
  makeCube(plugin, 1);
  plugin.set("gravity", 0);
  plugin.set("velocity", {0.1, 0, 0});
  ASSERT_EQ(plugin.activate(), HSP_OK);
  for (int i = 0; i < 10; ++i) plugin.tick({{NAN, 0, 0}});
  EXPECT_NEAR(plugin.position().x(), 9e-4, 1e-15);
  EXPECT_EQ(plugin.force(), Vector3d::Zero());
}

TEST(Motion, EnergyComesFromTheHandAlone) {
  PluginUnderTest plugin;
  makeCube(plugin, 0.5);
  plugin.set("stiffness", 2000);
  plugin.set("tether", 100);
  plugin.set("gravity", 0);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  plugin.tick({kFar});
  double work = 0, last = 0.06;
  const double before = plugin.energy();
  for (int i = 0; i < 20'000; ++i) {
    const double y = 0.06 - 0.02 * std::sin(1e-3 * i) * std::sin(1e-3 * i);
    plugin.tick({{0.01, y, 0}});
    work += -plugin.force().y() * (y - last);
    last = y;
    ASSERT_LE(plugin.energy() - before, work + 2e-4) << i;
  }
  EXPECT_GT(work, 1e-3);
}

/// Makes the cube a door about its left edge, which closes by itself and opens by 0.6 rad.
void makeDoor(PluginUnderTest& plugin) {
  makeCube(plugin, 1);
  plugin.set("joint", kHinge);
  plugin.set("pivot", {-0.05, 0, 0});
  plugin.set("axis", {0, 1, 0});
  plugin.set("angular_drag", 0.02);
  plugin.set("angular_tether", 0.5);
  plugin.set("limits", {0, 0.6});
}

double angleOf(const PluginUnderTest& plugin) {
  return 2 * std::atan2(plugin.pose.orientation[2], plugin.pose.orientation[0]);
}

TEST(Motion, ADoorIsPushedToItsStopFeltAsAWallThereAndClosesAgain) {
  constexpr uint32_t kEnds = HSP_OUT_AT_LOWEST | HSP_OUT_AT_HIGHEST;
  for (const double rate : {500.0, 1000.0, 4000.0, 10'000.0}) {
    PluginUnderTest plugin;
    makeDoor(plugin);
    ASSERT_EQ(plugin.activate(1, rate), HSP_OK);
    // the hand follows the front, whose normal is along z at first, to 6 mm below the surface of the opened door
    const Eigen::AngleAxisd open(0.6, Vector3d::UnitY());
    const Vector3d edge(-0.05, 0, 0), deep = edge + open * (Vector3d(0.03, 0.01, 0.044) - edge);
    const Vector3d start(0.03, 0.01, 0.06);
    const auto ticks = static_cast<int>(2 * rate);
    for (int i = 0; i < ticks; ++i) plugin.tick({start + std::min(1.0, 1.5 * i / ticks) * (deep - start)});
    EXPECT_NEAR(angleOf(plugin), 0.6, 1e-12) << rate;
    EXPECT_EQ(Vector3d(plugin.pose.angular), Vector3d::Zero());
    EXPECT_NEAR(plugin.force().norm(), 800 * 0.006, 1e-9) << "stiffness times depth, as of a wall that stands";
    EXPECT_NEAR(plugin.force().dot(open * Vector3d::UnitZ()), 4.8, 1e-9) << "along its normal";
    EXPECT_EQ(plugin.contacts[0].flags & kEnds, HSP_OUT_AT_HIGHEST);
    for (int i = 0; i < 4 * ticks; ++i) plugin.tick({kFar});
    EXPECT_EQ(angleOf(plugin), 0) << "the spring closes it";
    EXPECT_EQ(plugin.contacts[0].flags & kEnds, HSP_OUT_AT_LOWEST);
    EXPECT_EQ(Vector3d(plugin.pose.angular), Vector3d::Zero());
  }
}

TEST(Motion, ALeverHeldAgainstItsSpringPushesBackAsTheSpringDoes) {
  PluginUnderTest plugin;
  makeDoor(plugin);
  plugin.set("rest", -0.1);  // the closed door is pressed against its frame
  ASSERT_EQ(plugin.activate(), HSP_OK);
  for (int i = 0; i < 4000; ++i) plugin.tick({{0.04, 0, 0.05 - 0.01 * std::min(1.0, i / 1000.0)}});
  const double angle = angleOf(plugin);
  ASSERT_GT(angle, 0.05);
  ASSERT_LT(angle, 0.3);
  const Vector3d lever = Vector3d(plugin.contacts[0].point) - Vector3d(-0.05, 0, 0);  // in the model frame
  const Vector3d moment = lever.cross(-Vector3d(plugin.contacts[0].force));
  EXPECT_NEAR(moment.y(), 0.5 * (angle + 0.1), 1e-4);
}

TEST(Motion, ADoorBetweenStopsNeverPaysBackMoreThanAHandPutIn) {
  for (const double rate : {500.0, 1000.0, 4000.0, 10'000.0}) {
    PluginUnderTest plugin;
    makeDoor(plugin);
    plugin.set("damping", 2);
    ASSERT_EQ(plugin.activate(1, rate), HSP_OK);
    plugin.tick({kFar});
    const double before = plugin.energy();
    double work = 0, at_stop = 0;
    Vector3d last(0.03, 0.01, 0.06);
    const auto ticks = static_cast<int>(20 * rate);
    for (int i = 0; i < ticks; ++i) {
      const double t = i / rate, reach = 0.045 * std::sin(0.9 * t) * std::sin(0.9 * t);
      const Vector3d probe(0.02 + 0.01 * std::sin(3.1 * t), 0.01, 0.06 - reach * (1 + 0.5 * std::sin(7.3 * t)));
      plugin.tick({probe});
      work -= plugin.force().dot(probe - last);
      last = probe;
      ASSERT_LE(plugin.energy() - before, work + 2e-4) << rate << ' ' << i;
      ASSERT_GE(angleOf(plugin), 0);
      ASSERT_LE(angleOf(plugin), 0.6 + 1e-12);
      at_stop += std::fabs(angleOf(plugin) - 0.6) < 1e-9 ? 1 : 0;
    }
    EXPECT_GT(work, 1e-3);
    EXPECT_GT(at_stop, rate / 10);
  }
}

TEST(Motion, AResetAndALostSampleLeaveItWithinItsLimits) {
  PluginUnderTest plugin;
  makeDoor(plugin);
  plugin.set("spin", {0, 12, 0});
  ASSERT_EQ(plugin.activate(), HSP_OK);
  double widest = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i % 7 == 0) plugin.reset();
    plugin.tick({i % 5 == 0 ? Vector3d(NAN, 0, 0) : Vector3d(0.03, 0.01, 0.04)}, {},
                i % 11 == 0 ? uint32_t{HSP_IN_JUMP} : 0u);
    ASSERT_GE(angleOf(plugin), 0);
    ASSERT_LE(angleOf(plugin), 0.6 + 1e-12);
    widest = std::fmax(widest, angleOf(plugin));
  }
  EXPECT_NEAR(widest, 0.6, 1e-12) << "it was at its stop";
}

TEST(Motion, SaysWhatBodyItRefuses) {
  const auto complaint = [](auto change) {
    PluginUnderTest plugin;
    makeCube(plugin, 1);
    change(plugin);
    EXPECT_LT(plugin.activate(), 0);
    return plugin.log;
  };
  EXPECT_NE(complaint([](auto& p) { p.set("inertia", {1, 1, 3}); }).find("no moment above the sum of the other two"),
            std::string::npos);
  EXPECT_NE(complaint([](auto& p) { p.set("inertia", {1, 0.5, 0, 0, 1, 0, 0, 0, 1}); }).find("symmetric"),
            std::string::npos);
  EXPECT_NE(complaint([](auto& p) { p.set("inertia", {1, 0, 1}); }).find("above 0"), std::string::npos);
  EXPECT_NE(complaint([](auto& p) { p.set("inertia", {1, 1, 1, 0, 0, 0}); }).find("6 numbers"), std::string::npos);
  EXPECT_NE(complaint([](auto& p) {
              p.set("joint", kSlider);
              p.set("axis", {0, 0, 0});
            }).find("axis"),
            std::string::npos);
  EXPECT_NE(complaint([](auto& p) {
              p.set("mass", 1e-6);
              p.set("joint", kHinge);
              p.set("pivot", {0.2, 0, 0});
              p.set("tether", 1e6);
            }).find("at most 3.2e+04 rad/s at 1000 Hz"),
            std::string::npos);
  EXPECT_NE(complaint([](auto& p) { p.set("limits", {0, 1}); }).find("limits: a free body"), std::string::npos);
  EXPECT_NE(complaint([](auto& p) {
              p.set("motion", 1);
              p.set("limits", {0, 1});
            }).find("limits: end stops hold only a body that moves under forces, and this model is motion: kinematic"),
            std::string::npos);
  PluginUnderTest plugin;
  EXPECT_EQ(plugin.set("limits", {0, 1, 2}), HSP_E_ARG);
  EXPECT_EQ(plugin.set("limits", {NAN, 1}), HSP_E_ARG);
  EXPECT_EQ(plugin.set("mass", 1e-7), HSP_E_ARG);
  EXPECT_EQ(plugin.set("mass", 0), HSP_E_ARG);
}

}  // namespace
}  // namespace hapticd::test
