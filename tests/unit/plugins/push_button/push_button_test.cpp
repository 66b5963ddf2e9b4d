// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "../plugin_under_test.hpp"
#include "kernels/dynamics/button.hpp"

namespace hapticd::test {
namespace {

constexpr double kTop = 0.05;  // of the box, along y; and of the ball

struct Button {
  double k1 = 2000, end = 8000;
  std::vector<double> detent = {0, 0, 0.003, 6, 0.004, 2};
  std::string model = "box.yaml";

  dynamics::DetentCurve curve() const {
    std::vector<dynamics::DetentCurve::Knot> knots;
    for (size_t i = 0; i + 1 < detent.size(); i += 2) knots.push_back({detent[i], detent[i + 1]});
    return dynamics::DetentCurve(knots, end);
  }
  void make(PluginUnderTest& plugin, uint32_t probes = 1) const {
    ASSERT_EQ(plugin.set("geometry", kModels + model), HSP_OK);
    ASSERT_EQ(plugin.set("stiffness", k1), HSP_OK);
    ASSERT_EQ(plugin.set("detent", detent), HSP_OK);
    ASSERT_EQ(plugin.set("end_stiffness", end), HSP_OK);
    ASSERT_EQ(plugin.activate(probes), HSP_OK);
  }
};

/// The largest stable x2 below, or the smallest above, that is an equilibrium: what a slow press or release meets.
double forceOnBranch(const Button& button, double travel, bool from_below) {
  const auto all = dynamics::buttonEquilibria(button.k1, button.curve(), travel);
  double force = NAN;
  for (int i = 0; i < all.count; ++i) {
    const auto& e = all.at[static_cast<size_t>(i)];
    if (e.stable && (!from_below || std::isnan(force))) force = e.force;
  }
  return force;
}

TEST(PushButton, ForceAgainstTravelIsTheClosedFormOnBothBranches) {
  for (const double k1 : {500.0, 2000.0, 6000.0}) {
    Button button;
    button.k1 = k1;
    PluginUnderTest plugin;
    button.make(plugin);
    plugin.tick({{0, kTop + 1e-3, 0}});
    double worst = 0;
    const auto goTo = [&](double travel, bool inward) {
      plugin.tick({{0.01, kTop - travel, -0.02}});
      worst = std::fmax(worst, std::fabs(plugin.force().y() - forceOnBranch(button, travel, inward)));
    };
    const double last = 0.03;
    for (int i = 1; i <= 3000; ++i) goTo(last * i / 3000, true);
    EXPECT_LT(worst, 1e-9) << "in, k1 " << k1;
    worst = 0;
    for (int i = 3000; i >= 1; --i) goTo(last * i / 3000, false);
    EXPECT_LT(worst, 1e-9) << "out, k1 " << k1;
  }
}

TEST(PushButton, ClicksInTheVeryTickItSnapsAndBackWithHysteresis) {
  const Button button;  // falls with 4000 N/m: steeper than k1, so it snaps
  PluginUnderTest plugin;
  button.make(plugin);
  plugin.tick({{0, kTop + 1e-3, 0}});
  const double in = 0.003 + 6 / button.k1, out = 0.004 + 2 / button.k1;  // where a branch ends
  std::vector<double> clicks;
  uint32_t direction = 0;
  constexpr double kWay = 1.003e-5;  // a tick, so that none ends on the snap itself
  const auto goTo = [&](double travel) {
    plugin.tick({{0, kTop - travel, 0}});
    const uint32_t flags = plugin.contacts[0].flags;
    if ((flags & HSP_OUT_EVENT) != 0)
      clicks.push_back(travel), direction = flags & (HSP_OUT_WENT_IN | HSP_OUT_CAME_OUT);
  };
  for (int i = 1; i <= 1000; ++i) goTo(kWay * i);
  ASSERT_EQ(clicks.size(), 1u);
  EXPECT_EQ(direction, HSP_OUT_WENT_IN);
  EXPECT_GE(clicks[0], in * (1 - 1e-12));
  EXPECT_LT(clicks[0] - kWay, in) << "not a tick late";
  clicks.clear();
  for (int i = 999; i >= 0; --i) goTo(kWay * i);
  ASSERT_EQ(clicks.size(), 1u);
  EXPECT_EQ(direction, HSP_OUT_CAME_OUT);
  EXPECT_LE(clicks[0], out * (1 + 1e-12));
  EXPECT_GT(clicks[0] + kWay, out) << "not a tick late";
  EXPECT_LT(out, in) << "hysteresis";
}

TEST(PushButton, AGentleDetentClicksWithoutAJump) {
  Button button;
  button.k1 = 6000;  // the fall of 4000 N/m is followed all the way
  PluginUnderTest plugin;
  button.make(plugin);
  plugin.tick({{0, kTop + 1e-3, 0}});
  int events = 0;
  double last = 0, steepest = 0;
  for (int i = 1; i <= 8000; ++i) {
    plugin.tick({{0, kTop - 1e-6 * i, 0}});
    events += (plugin.contacts[0].flags & HSP_OUT_EVENT) != 0;
    steepest = std::fmax(steepest, std::fabs(plugin.force().y() - last));
    last = plugin.force().y();
  }
  EXPECT_EQ(events, 1);
  EXPECT_LT(steepest, 1e-6 * 6000 * 4000 / 2000 * 1.01) << "slope k1 k2/(k1 + k2), Eq. 10";
}

TEST(PushButton, AnyCapPressesTheSameAtItsMiddleAndAnyCurveIsTaken) {
  const std::pair<const char*, double> caps[] = {
      {"box.yaml", kTop}, {"sphere.yaml", kTop}, {"cylinder.yaml", kTop}, {"cap.yaml", 0.005}};
  for (const auto& [model, top] : caps) {
    Button button;
    button.model = model;
    button.k1 = 3000;
    button.detent = {0, 0, 0.001, 1, 0.002, 3, 0.0025, 1.5, 0.004, 2};
    button.end = 20000;
    PluginUnderTest plugin;
    button.make(plugin);
    plugin.tick({{0, top + 1e-3, 0}});
    for (int i = 1; i <= 900; ++i) {
      plugin.tick({{0, top - 1e-5 * i, 0}});
      EXPECT_NEAR(plugin.force().y(), forceOnBranch(button, 1e-5 * i, true), 1e-7) << model << " at " << i;
      EXPECT_LT(std::hypot(plugin.force().x(), plugin.force().z()), 1e-6);
    }
  }
}

TEST(PushButton, ASlopingCapBalancesAlongItsAxis) {
  Button button;
  button.model = "sphere.yaml";
  PluginUnderTest plugin;
  button.make(plugin);
  const Vector3d out = Vector3d(0.4, 1, -0.2).normalized();
  plugin.tick({(kTop + 1e-3) * out});
  for (int i = 1; i <= 300; ++i) plugin.tick({kTop * out - 1e-5 * i * Vector3d::UnitY()});
  const double x2 = -plugin.position().y();
  ASSERT_GT(x2, 5e-4);
  for (int i = 0; i < 50; ++i) plugin.tick({kTop * out - 3e-3 * Vector3d::UnitY()});  // the foot settles
  EXPECT_NEAR(plugin.force().y(), button.curve().force(-plugin.position().y()), 1e-6);
}

TEST(PushButton, WorksInAnyPose) {
  const Button button;
  PluginUnderTest plugin;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Vector3d(1, 2, 3).normalized()));
  const Vector3d origin(0.3, -0.2, 0.5);
  for (int i = 0; i < 3; ++i) plugin.pose.position[i] = origin[i];
  const double q[4] = {turn.w(), turn.x(), turn.y(), turn.z()};
  std::copy(q, q + 4, plugin.pose.orientation);
  button.make(plugin);
  const Vector3d up = turn * Vector3d::UnitY();
  plugin.tick({origin + (kTop + 1e-3) * up});
  for (int i = 1; i <= 500; ++i) {
    plugin.tick({origin + (kTop - 1e-5 * i) * up});
    EXPECT_LT((plugin.force() - forceOnBranch(button, 1e-5 * i, true) * up).norm(), 1e-9);
  }
}

TEST(PushButton, ABadSampleLeavesItPressedAndLettingGoBringsItBack) {
  const Button button;
  PluginUnderTest plugin;
  button.make(plugin);
  plugin.tick({{0, kTop + 1e-3, 0}});
  for (int i = 0; i < 5; ++i) plugin.tick({{0, kTop - 0.008, 0}});
  const double pressed = plugin.position().y();
  EXPECT_LT(pressed, -0.004);
  plugin.tick({{0, kTop - 0.008, 0}}, {}, HSP_IN_INVALID);
  EXPECT_EQ(plugin.force(), Vector3d::Zero());
  EXPECT_EQ(plugin.position().y(), pressed);
  plugin.tick({{0, kTop + 0.01, 0}});
  EXPECT_EQ(plugin.position().y(), 0);
  plugin.tick({{0, kTop - 0.001, 0}});
  EXPECT_NEAR(plugin.force().y(), forceOnBranch(button, 0.001, true), 1e-9);
}

/// An arm that is gone holds no button down.
TEST(PushButton, ComesBackIfNoSampleComesAnyMore) {
  const Button button;
  PluginUnderTest plugin;
  button.make(plugin);
  plugin.tick({{0, kTop + 1e-3, 0}});
  for (int i = 0; i < 5; ++i) plugin.tick({{0, kTop - 0.008, 0}});
  const double pressed = plugin.position().y();
  for (int i = 0; i < 20; ++i) plugin.tick({{0, kTop - 0.008, 0}}, {}, HSP_IN_INVALID);
  EXPECT_EQ(plugin.position().y(), pressed);
  for (int i = 0; i < 40; ++i) plugin.tick({{0, kTop - 0.008, 0}}, {}, HSP_IN_INVALID);
  EXPECT_EQ(plugin.position().y(), 0);
}

TEST(PushButton, AnArmThatIsGoneDoesNotLetGoOfWhatAnotherPresses) {
  const Button button;
  PluginUnderTest plugin;
  button.make(plugin, 2);
  const Eigen::Vector3d away(0.02, kTop + 0.05, 0);
  plugin.tick({away, {0, kTop + 1e-3, 0}});
  plugin.own_flags = {HSP_IN_INVALID, 0};
  for (int i = 0; i < 100; ++i) plugin.tick({away, {0, kTop - 0.008, 0}});
  const double pressed = plugin.position().y();
  EXPECT_LT(pressed, -1e-3);
  plugin.tick({away, {0, kTop - 0.008, 0}}, {}, HSP_IN_INVALID);
  EXPECT_EQ(plugin.position().y(), pressed) << "one sample was lost";
}

/// Two fingers share a detent. As one arm is lost, the other finger comes to bear all of it, and not at once. When the
/// arm is back, the other finger is not let go at once, either.
TEST(PushButton, AnArmThatIsGoneLeavesItsShareToTheOtherSlowlyAndTakesItBackSlowly) {
  const Button button;
  PluginUnderTest plugin;
  button.make(plugin, 2);
  const std::vector<Eigen::Vector3d> fingers{{-0.01, kTop - 0.002, 0}, {0.01, kTop - 0.002, 0}};
  plugin.tick({{-0.01, kTop + 1e-3, 0}, {0.01, kTop + 1e-3, 0}});
  for (int i = 0; i < 5; ++i) plugin.tick(fingers);
  const double shared = plugin.force(1).y();
  plugin.own_flags = {HSP_IN_INVALID, 0};
  double last = shared, most = 0;
  const auto press = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      plugin.tick(fingers);
      most = std::max(most, std::abs(plugin.force(1).y() - last));
      last = plugin.force(1).y();
    }
  };
  press(100);
  const double alone = last;
  EXPECT_NEAR(alone, forceOnBranch(button, 0.002, true), 1e-9);
  EXPECT_GT(alone, shared + 0.5);
  EXPECT_LT(most, 0.1 * (alone - shared)) << "in one tick, as it leaves";
  most = 0;
  plugin.own_flags = {0, 0};
  press(100);
  EXPECT_NEAR(last, shared, 1e-9);
  EXPECT_LT(most, 0.1 * (alone - shared)) << "in one tick, as it comes back";
}

TEST(PushButton, EnergyOverAPressIsNeverGained) {
  const Button button;
  PluginUnderTest plugin;
  button.make(plugin);
  plugin.tick({{0, kTop + 1e-3, 0}});
  double work = 0, force = 0, last = kTop + 1e-3;
  for (int i = 0; i <= 40'000; ++i) {
    const double y = kTop + 1e-3 - 5e-3 * (1 - std::cos(2 * M_PI * i / 20'000));
    plugin.tick({{0, y, 0}});
    work -= (force + plugin.force().y()) / 2 * (y - last);
    force = plugin.force().y(), last = y;
    ASSERT_GE(work, plugin.energy() - 1e-5) << i;
  }
  EXPECT_GT(work, 1e-3) << "two clicks in, two out: each takes its loop";
}

/// Two fingers press and let go, each in its own time: both on the cap, or one against it from behind.
TEST(PushButton, BalancesAllFingersAndPaysNoneOfThemMoreThanTheyGave) {
  for (const double k1 : {500.0, 2000.0, 6000.0})
    for (const double side : {1.0, -1.0}) {
      Button button;
      button.k1 = k1;
      PluginUnderTest plugin;
      button.make(plugin, 2);
      const auto finger = [](double phase) { return 1e-3 - 4e-3 * (1 - std::cos(phase)); };  // [m] above the cap
      double work = 0, wrong = 0, last[2] = {}, force[2] = {};
      for (int i = 0; i <= 60'000; ++i) {
        const double y[2] = {kTop + finger(3e-4 * i), side * (kTop + finger(4.7e-4 * i))};
        plugin.tick({{0.02, y[0], 0}, {-0.02, y[1], 0}});
        double sum = 0;
        for (size_t k = 0; k < 2; ++k) {
          const double now = plugin.force(k).y();
          if (i > 0) work -= (force[k] + now) / 2 * (y[k] - last[k]);
          force[k] = now, last[k] = y[k], sum += now;
        }
        const double x2 = -plugin.position().y();
        if (x2 > 0) wrong = std::fmax(wrong, std::fabs(sum - button.curve().force(x2)));
        ASSERT_GE(work, plugin.energy() - 1e-5) << k1 << ", " << side << ", " << i;
      }
      EXPECT_LT(wrong, 1e-6) << k1 << ", " << side;
    }
}

TEST(PushButton, SaysWhatIsWrongWithACurve) {
  for (const auto& [detent, what] : {std::pair{std::vector<double>{0, 0, 0.003, 4, 0.002, 3}, "row 3"},
                                     {std::vector<double>{0, 0, 0.003, 0}, "above 0 N"},
                                     {std::vector<double>{0, 1}, "row 1"},
                                     {std::vector<double>{0.001, 0, 0.003, 4, 0.002, 3}, "row 1"},
                                     {std::vector<double>{0.001, 0, 0.003, 4, 0.002, 3}, "\ndetent[2]: row 3"}}) {
    PluginUnderTest plugin;
    plugin.set("geometry", kModels + "box.yaml");
    ASSERT_EQ(plugin.set("detent", detent), HSP_OK);
    EXPECT_LT(plugin.activate(), 0);
    EXPECT_NE(plugin.log.find(what), std::string::npos) << plugin.log;
  }
}

}  // namespace
}  // namespace hapticd::test
