// SPDX-License-Identifier: MIT
#include "kernels/dynamics/pendulum.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>

#include "../plugin_under_test.hpp"

namespace hapticd::test {
namespace {

const Vector3d kFar(0, 0, 10);
const Vector3d kPivot(0, 0.25, 0);

/// A ball of 50 mm radius, 0.25 m below its pivot, that swings in the plane of x and y.
void makeBall(PluginUnderTest& plugin, double mass, double damping = 0) {
  ASSERT_EQ(plugin.set("geometry", kModels + "sphere.yaml"), HSP_OK);
  ASSERT_EQ(plugin.set("pivot", {0, 0.25, 0}), HSP_OK);
  ASSERT_EQ(plugin.set("mass", mass), HSP_OK);
  ASSERT_EQ(plugin.set("damping", damping), HSP_OK);
}

double angleOf(const PluginUnderTest& plugin) {
  const Vector3d arm = plugin.position() - kPivot;
  return std::atan2(arm.x(), -arm.y());
}

TEST(Pendulum, SwingsAsItsLawSaysAndKeepsItsEnergy) {
  PluginUnderTest plugin;
  makeBall(plugin, 0.5);
  plugin.set("angle", 1.2);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  EXPECT_NE(plugin.report.flags & HSP_R_MOVES, 0u);
  dynamics::PendulumState state{1.2, 0};
  const dynamics::PendulumLaw law{0.5, 0.5 * 0.0625, 0.25, 0, 9.81};
  plugin.tick({kFar});
  const double energy = plugin.energy();
  for (int i = 0; i < 20'000; ++i) {
    plugin.tick({kFar});
    state = dynamics::advance(law, state, 0, 1e-3);
  }
  EXPECT_NEAR(angleOf(plugin), state.angle, 1e-9);
  EXPECT_NEAR(plugin.pose.angular[2], state.rate, 1e-9);
  EXPECT_NEAR(plugin.energy() / energy, 1, 1e-9);
  EXPECT_NEAR((plugin.position() - kPivot).norm(), 0.25, 1e-14);
}

/// 1e-6 kg at 8e-9 m turns by 35 rad in a tick of 1 kHz: it went through the probe and kicked it with 46 N.
TEST(Pendulum, ThatNoContactCanFollowIsRefused) {
  for (const double length : {8e-9, 1e-6, 9e-6}) {
    PluginUnderTest plugin;
    makeBall(plugin, 1e-6);
    ASSERT_EQ(plugin.set("length", length), HSP_OK);
    EXPECT_EQ(plugin.activate(), HSP_E_ARG) << length;
  }
  PluginUnderTest plugin;
  makeBall(plugin, 1e-6);
  ASSERT_EQ(plugin.set("length", 1e-3), HSP_OK);
  EXPECT_EQ(plugin.activate(), HSP_OK) << "99 rad/s";
}

TEST(Pendulum, PositiveAnglesTurnByTheRightHandAboutItsAxis) {
  PluginUnderTest plugin;
  makeBall(plugin, 1);
  plugin.set("axis", {0, 0, -3});
  plugin.set("angle", 0.3);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  plugin.tick({kFar});
  EXPECT_NEAR(angleOf(plugin), -0.3, 1e-14);
}

TEST(Pendulum, AHeldProbeBearsItsWeight) {
  PluginUnderTest plugin;
  makeBall(plugin, 0.5, 0.5);
  plugin.set("stiffness", 2000);
  ASSERT_EQ(plugin.activate(), HSP_OK);
  // pushed slowly to the side and held: the ball leans on the probe
  for (int i = 0; i < 20'000; ++i) plugin.tick({{-0.052 + 0.1 * std::min(i / 5000.0, 1.0), 0.01, 0}});
  const double angle = angleOf(plugin);
  ASSERT_GT(angle, 0.1);
  const Vector3d contact = Vector3d(0.048, 0.01, 0) - kPivot;
  const double torque = -contact.cross(plugin.force()).z();
  EXPECT_NEAR(torque, 0.5 * 9.81 * 0.25 * std::sin(angle), 2e-4);
  EXPECT_NEAR(plugin.pose.angular[2], 0, 1e-6);
}

TEST(Pendulum, ThePoseAndItsVelocitiesBelongTogether) {
  PluginUnderTest plugin;
  makeBall(plugin, 1, 0.01);
  plugin.set("rate", 20);  // it goes round
  ASSERT_EQ(plugin.activate(), HSP_OK);
  plugin.tick({kFar});
  for (int i = 0; i < 3000; ++i) {
    const hsp_pose before = plugin.pose;
    plugin.tick({kFar});
    const Vector3d way = (plugin.position() - Vector3d(before.position)) / 1e-3;
    EXPECT_LT((way - (Vector3d(before.linear) + Vector3d(plugin.pose.linear)) / 2).norm(), 2e-3);
  }
}

TEST(Pendulum, OfAnyMassIsPushedWithoutTremor) {
  for (double mass = 1e-6; mass < 2e3; mass *= 10) {
    PluginUnderTest plugin;
    makeBall(plugin, mass);
    plugin.set("stiffness", 6000);
    plugin.set("contact_damping", 20);
    ASSERT_EQ(plugin.activate(2, 1500), HSP_OK);
    double late = 0;
    for (int i = 0; i < 6000; ++i) {
      plugin.tick({{-0.049, 0, 0}, {0.049, 0, 0}});
      ASSERT_TRUE(plugin.position().allFinite());
      if (i > 3000) late = std::fmax(late, std::fabs(plugin.pose.angular[2]));
    }
    EXPECT_LT(late, 1e-3) << mass;
  }
}

TEST(Pendulum, AResetAndAJumpForgetTheHand) {
  for (const bool jump : {false, true}) {
    PluginUnderTest plugin;
    makeBall(plugin, 1);
    ASSERT_EQ(plugin.activate(1, 1000, Vector3d::Zero()), HSP_OK);
    plugin.tick({{-0.045, 0, 0}});
    EXPECT_LT(plugin.force().x(), -1);
    if (!jump) plugin.reset();
    plugin.tick({kFar}, {}, jump ? uint32_t{HSP_IN_JUMP} : 0u);
    EXPECT_EQ(plugin.pose.angular[2], 0);
  }
}

uint32_t endOf(const PluginUnderTest& plugin) {
  return plugin.contacts[0].flags & (HSP_OUT_AT_LOWEST | HSP_OUT_AT_HIGHEST);
}

TEST(Pendulum, StandsAtTheEndStopAgainstWhichAHandPressesItAndComesBack) {
  for (const double rate : {500.0, 1000.0, 4000.0}) {
    PluginUnderTest plugin;
    makeBall(plugin, 0.5, 0.05);
    plugin.set("stiffness", 2000);
    plugin.set("angle", -0.1);
    plugin.set("limits", {-0.15, 0.3});
    ASSERT_EQ(plugin.activate(1, rate), HSP_OK);
    const auto ticks = static_cast<int>(2 * rate);
    for (int i = 0; i < ticks; ++i) plugin.tick({{-0.08 + 0.11 * std::min(1.0, 1.5 * i / ticks), 0.005, 0}});
    EXPECT_NEAR(angleOf(plugin), 0.3, 1e-12) << rate;
    EXPECT_EQ(Vector3d(plugin.pose.angular), Vector3d::Zero());
    EXPECT_EQ(endOf(plugin), HSP_OUT_AT_HIGHEST);
    EXPECT_NEAR(plugin.force().norm(), 2000 * plugin.contacts[0].depth_m, 1e-9) << "as a wall that stands";
    EXPECT_LT(plugin.force().x(), -1) << "against the hand";
    double least = 1;
    for (int i = 0; i < 20 * ticks; ++i) {
      plugin.tick({kFar});
      least = std::fmin(least, angleOf(plugin));
      ASSERT_LE(angleOf(plugin), 0.3 + 1e-12);
    }
    EXPECT_NEAR(least, -0.15, 1e-12) << "it swings to the other stop";
    EXPECT_NEAR(angleOf(plugin), 0, 1e-3) << "and comes to rest";
    EXPECT_EQ(endOf(plugin), 0u);
  }
}

TEST(Pendulum, AStopGivesNoEnergy) {
  PluginUnderTest plugin;
  makeBall(plugin, 0.5);
  plugin.set("angle", 1.2);
  plugin.set("limits", {-0.4, 1.2});
  ASSERT_EQ(plugin.activate(), HSP_OK);
  plugin.tick({kFar});
  const double start = plugin.energy();
  EXPECT_NEAR(start, 0.5 * 9.81 * 0.25 * (1 - std::cos(1.2)), 1e-12) << "above that of the lowest place";
  double before = start;
  for (int i = 0; i < 5000; ++i) {
    plugin.tick({kFar});
    ASSERT_LE(plugin.energy(), before + 1e-9 * start) << i;
    before = plugin.energy();
  }
  EXPECT_NEAR(before, 0.5 * 9.81 * 0.25 * (1 - std::cos(0.4)), 1e-6) << "it fell from its stop without a rate";
}

TEST(Pendulum, RefusesEndStopsThatItDoesNotStartBetween) {
  for (const auto& [limits, words] : {std::pair{std::array{0.1, 0.5}, "the pendulum starts at `angle`"},
                                      std::pair{std::array{0.5, -0.5}, "greater value first"}}) {
    PluginUnderTest plugin;
    makeBall(plugin, 1);
    plugin.set("limits", {limits[0], limits[1]});
    EXPECT_LT(plugin.activate(), 0);
    EXPECT_NE(plugin.log.find(words), std::string::npos) << plugin.log;
  }
}

TEST(Pendulum, HasTheInertiaThatItIsGivenWithAndWithoutLengthOrWeight) {
  for (const double length : {0.0, 0.1, 0.25}) {
    PluginUnderTest plugin;
    makeBall(plugin, 1);
    plugin.set("length", length);
    plugin.set("inertia", 0.08);
    plugin.set("rate", 1);
    ASSERT_EQ(plugin.activate(1, 1000, Vector3d::Zero()), HSP_OK);
    plugin.tick({kFar});
    EXPECT_NEAR(plugin.energy(), 0.5 * 0.08, 1e-12) << length;
    for (int i = 0; i < 1000; ++i) plugin.tick({kFar});
    EXPECT_NEAR(angleOf(plugin), 1, 1e-9);
  }
}

TEST(Pendulum, RefusesASwingFasterThanTheRate) {
  PluginUnderTest plugin;
  makeBall(plugin, 1e6);
  plugin.set("inertia", 1e-6);
  EXPECT_LT(plugin.activate(), 0);
  EXPECT_NE(plugin.log.find("at most 3.2e+04 rad/s at 1000 Hz"), std::string::npos) << plugin.log;
}

}  // namespace
}  // namespace hapticd::test
