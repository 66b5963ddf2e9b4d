// SPDX-License-Identifier: MIT
#include "servo/velocity/probe_velocity.hpp"

#include <gtest/gtest.h>

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

constexpr double kDt = 1e-3;

std::vector<ProbeVelocity> everyKind() {
  std::vector<ProbeVelocity> all;
  for (const char* name : {"window", "butterworth", "foaw", "least_squares", "kalman"}) {
    const double knob = std::string_view(name) == "butterworth" ? 120 : std::string_view(name) == "kalman" ? 1e4 : 5;
    all.emplace_back(velocity::make(name, knob, 1 / kDt));
  }
  return all;
}

// Without the reset, the way of the jump is in the differences of as many samples as the estimator remembers.
TEST(ProbeVelocity, IsSmallFromTheTickOfAJumpOn) {
  for (ProbeVelocity& probe : everyKind()) {
    for (int i = 0; i < 50; ++i) probe.update({0, 0, 0.01}, i > 0 ? kDt : 0);
    for (int i = 0; i < 50; ++i) {
      EXPECT_EQ(probe.update({0, 0, 0.06}, kDt), Vector3d::Zero());
      EXPECT_NEAR(probe.speed(), i == 0 ? 50 : 0, 1e-9);
    }
  }
}

TEST(ProbeVelocity, TakesNoDifferenceAcrossAGap) {
  for (ProbeVelocity& probe : everyKind()) {
    for (int i = 0; i < 50; ++i) probe.update({0, 0, 0}, i > 0 ? kDt : 0);
    probe.reset();
    for (int i = 0; i < 50; ++i) EXPECT_EQ(probe.update({0, 0, 0.015}, kDt), Vector3d::Zero());
  }
}

TEST(ProbeVelocity, IsTheEstimatorsWhereNothingJumps) {
  VelocityEstimator alone = velocity::make("window", 5, 1 / kDt);
  ProbeVelocity probe(alone);
  for (int i = 0; i < 50; ++i) {
    const Vector3d p(1e-3 * i, 2e-4 * i * i / 50, 0);
    EXPECT_EQ(probe.update(p, i > 0 ? kDt : 0), alone.update(p, i > 0 ? kDt : 0));
  }
}

}  // namespace
}  // namespace hapticd::servo
