// SPDX-License-Identifier: MIT
/// The plugins that ship are never silenced because of steep laws under taps, edges or snaps.
#include <cmath>

#include "scenario.hpp"
#include "shipped.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

/// Taps from above onto something whose top is at y = `top`: contact of a quarter of a tenth of a second each.
std::vector<Sent> tap(Scenario& scenario, double top, double speed, double seconds = 0.5) {
  constexpr double kPeriod = 0.05, kPulse = 2 * M_PI / kPeriod;
  return scenario.run(seconds, [&](double t) {
    scenario.moveTo(Vector3d(0.001, top - speed / kPulse * std::sin(kPulse * t), 0));
    return Nanoseconds{0};
  });
}

class SteepLaw : public testing::TestWithParam<int> {};

TEST_P(SteepLaw, OfASphereIsNotSilencedUnderTaps) {
  for (const double speed : {0.45, 0.6, 0.75, 0.92})
    for (const char* damping : {"0", "5"}) {
      Scenario scenario({.models = shipped("  - name: sphere\n    plugin: nurbs_rigid\n    parameters: {geometry: "
                                           "HERE/models/sphere.yaml, stiffness: 800, exponent: " +
                                           std::to_string(GetParam()) + ", damping: " + damping + "}\n")});
      const auto sent = tap(scenario, 0.05, speed);
      EXPECT_EQ(scenario.trouble(), ShapeFault::kNone) << speed << " m/s, damping " << damping;
      EXPECT_GT(largest(sent), 2.5) << speed;
    }
}

TEST_P(SteepLaw, OfAPendulumIsNotSilencedUnderTaps) {
  for (const double speed : {0.45, 0.6, 0.75, 0.92}) {
    Scenario scenario(
        {.models = shipped("  - name: pendulum\n    plugin: pendulum\n    parameters: {geometry: "
                           "HERE/models/sphere.yaml, pivot: [0, 0.25, 0], axis: [0, 0, 1], mass: 0.5, length: "
                           "0.25, damping: 0.002, stiffness: 1000, exponent: " +
                           std::to_string(GetParam()) + "}\n")});
    const auto sent = tap(scenario, 0.05, speed);
    EXPECT_EQ(scenario.trouble(), ShapeFault::kNone) << speed << " m/s";
    EXPECT_GT(largest(sent), 1) << speed;
  }
}
INSTANTIATE_TEST_SUITE_P(Each, SteepLaw, testing::Values(1, 2, 3));

/// Round a box and through its edges, pressed in by 2 mm: each edge turns the force by a right angle at once.
TEST(Edges, OfABoxAreNoKicks) {
  Scenario scenario({.models = shipped("  - name: box\n    plugin: nurbs_rigid\n    parameters: {geometry: "
                                       "HERE/models/box.yaml, stiffness: 1000}\n")});
  const auto sent = scenario.run(2, [&](double t) {
    scenario.moveTo(Vector3d(0.07 * std::cos(4 * t), 0.07 * std::sin(4 * t), 0.001).cwiseMax(-0.048).cwiseMin(0.048));
    return Nanoseconds{0};
  });
  EXPECT_EQ(scenario.trouble(), ShapeFault::kNone);
  EXPECT_GT(largest(sent), 1);
}

/// The spring of friction may store more than the wall: a stuck point 50 mm behind the hand, in a wall 7 mm deep.
TEST(Friction, OfASoftWallGivesBackNoMoreThanItTook) {
  Scenario scenario({.models = shipped("  - name: box\n    plugin: nurbs_rigid\n    parameters: {geometry: "
                                       "HERE/models/box.yaml, stiffness: 150, exponent: 2, friction_static: 1.5, "
                                       "friction_dynamic: 1.5}\n")});
  const auto sent = scenario.run(2, [&](double t) {
    const double along = t < 0.2 ? 0 : std::abs(std::remainder((t - 0.2) / 0.2, 2));  // 80 mm to and fro, each in 0.2 s
    scenario.moveTo(Vector3d(0.08 * along - 0.04, 0.055 - std::min(0.012, 0.08 * t), 0));
    return Nanoseconds{0};
  });
  EXPECT_EQ(scenario.trouble(), ShapeFault::kNone);
  EXPECT_GT(largest(sent), 5);
}

TEST(Snaps, OfAButtonAreNoKicks) {
  Scenario scenario(
      {.models = shipped("  - name: button\n    plugin: push_button\n    parameters: {geometry: "
                         "HERE/models/box.yaml, stiffness: 2000, detent: [[0, 0], [0.003, 5], [0.004, 0.5], "
                         "[0.006, 3]]}\n")});
  const auto sent = tap(scenario, 0.05, 0.6, 2);
  EXPECT_EQ(scenario.trouble(), ShapeFault::kNone);
  EXPECT_GT(largest(sent), 2);
}

TEST(Snaps, ThroughAShellAreNoKicks) {
  Scenario scenario({.models = shipped("  - name: shell\n    plugin: nurbs_rigid\n    parameters: {geometry: "
                                       "HERE/models/sphere.yaml, stiffness: 1500, sides: both, pop_through: 4}\n")});
  const auto sent = tap(scenario, 0.05, 0.6, 2);
  EXPECT_EQ(scenario.trouble(), ShapeFault::kNone);
  EXPECT_GT(largest(sent), 2);
}

}  // namespace
}  // namespace hapticd::servo
