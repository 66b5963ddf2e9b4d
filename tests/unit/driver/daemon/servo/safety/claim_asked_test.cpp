// SPDX-License-Identifier: MIT
/// A live parameter that somebody sets may change the force at once. It opens no door for a plugin that kicks, and what
/// is held back of it is no fault of the plugin.
#include <cmath>

#include "claim_rig.hpp"

namespace hapticd::servo {
namespace {

using Eigen::Vector3d;

/// Sets a parameter, and takes the next step at the origin.
Vector3d asked(Rested& claim, double force) {
  claim.claim.expectChange(true);
  return claim.next(at({0, 0, 0}, {0, force, 0}));
}
Vector3d unasked(Rested& claim, double force) {
  return claim.next(at({0, 0, 0}, {0, force, 0}));
}

TEST(Claim, AChangeThatWasAskedForComesAtOnceThreeTimesAndThenTwiceASecond) {
  Rested rests;
  double force = 0;
  for (int i = 0; i < 3; ++i) {
    force += 5;
    EXPECT_EQ(asked(rests, force).y(), force);
    EXPECT_FALSE(rests.held);
    EXPECT_FALSE(rests.claim.excused());
    EXPECT_EQ(unasked(rests, force).y(), force) << "and stays";
  }
  force += 5;
  EXPECT_NEAR(asked(rests, force).y(), force - 5 + Claim::kStep, 1e-9);
  EXPECT_TRUE(rests.held);
  for (int i = 0; i < 500; ++i) unasked(rests, force);
  EXPECT_EQ(asked(rests, force + 5).y(), force + 5) << "half a second later";
  Rested once;
  asked(once, 5);
  EXPECT_NEAR(unasked(once, 10).y(), 5 + Claim::kStep, 1e-9) << "what was asked for is one step";
  EXPECT_TRUE(once.held);
  EXPECT_FALSE(once.claim.excused());
}

TEST(Claim, AskingInEveryStepOpensNoDoorForAKick) {
  Rested kicked;
  int through = 0;
  double most = 0;
  for (int i = 0; i < 2000; ++i) {
    const double let = asked(kicked, i % 2 == 0 ? 8 : -8).norm();
    through += kicked.held ? 0 : 1;
    if (kicked.held) most = std::max(most, let);
    ASSERT_TRUE(!kicked.held || kicked.claim.excused()) << "who asks blames nobody";
  }
  EXPECT_NEAR(through, Claim::kAsked + 2 * Claim::kAskedPerSecond, 1.1);
  EXPECT_LE(most, Claim::kStep + 2 * Claim::kDrift * kTick + 1e-9);
}

/// Faster than what may drift: it is felt later than it was asked for, and it is nobody's fault.
TEST(Claim, AnAnimatedParameterComesLateAndBlamesNobody) {
  Rested animated;
  double force = 0;
  int held = 0;
  for (int i = 0; i < 2000; ++i) {
    force = 4 - 4 * std::cos(2 * M_PI * 20 * i * kTick);  // 500 N/s at most
    asked(animated, force);
    held += animated.held ? 1 : 0;
    ASSERT_TRUE(!animated.held || animated.claim.excused()) << i;
  }
  EXPECT_GT(held, 100) << "nothing was held back: no test";
  for (int i = 0; i < 200; ++i) {
    const double let = unasked(animated, force).y();
    ASSERT_TRUE(!animated.held || animated.claim.excused()) << i;
    if (i > 100) {
      ASSERT_EQ(let, force) << i;
    }
  }
  Rested slow;  // slower: never held back
  for (int i = 0; i < 2000; ++i) {
    asked(slow, 4 - 4 * std::cos(2 * M_PI * 3 * i * kTick));
    ASSERT_FALSE(slow.held) << i;
  }
}

TEST(Claim, WhatWasAskedForExcusesAPluginNoLongerThanItTakes) {
  Rested later;
  for (int i = 1; i <= 3; ++i) asked(later, 10 * i);
  asked(later, 40);
  int excused = 0;
  for (int i = 0; i < 1000; ++i) {
    unasked(later, 40);
    excused += later.claim.excused() ? 1 : 0;
  }
  EXPECT_NEAR(excused, 10 / Claim::kDrift / kTick, 2) << "10 N at 100 N/s";
  unasked(later, -40);
  EXPECT_TRUE(later.held);
  EXPECT_FALSE(later.claim.excused());
  Rested far;
  for (int i = 0; i < 3; ++i) asked(far, i % 2 == 0 ? 1e6 : 0);
  unasked(far, 0);
  for (int i = 0; i < 4; ++i) asked(far, i % 2 == 0 ? 1e6 : -1e6);
  excused = 0;
  for (int i = 0; i < 3000; ++i) {
    unasked(far, -1e6);
    excused += far.claim.excused() ? 1 : 0;
  }
  EXPECT_NEAR(excused, Claim::kExcused / kTick, 2) << "a second at most";
}

TEST(Claim, AChangeWithoutConsentComesSlowlyAndIsNoFault) {
  Rested rests;
  rests.claim.expectChange(false);
  EXPECT_NEAR(unasked(rests, 8).y(), Claim::kStep, 1e-9);
  EXPECT_TRUE(rests.held);
  EXPECT_TRUE(rests.claim.excused());
  double force = 0;
  for (int i = 0; i < 80; ++i) force = unasked(rests, 8).y();
  EXPECT_EQ(force, 8);
  EXPECT_FALSE(rests.held);
}

TEST(Claim, AskingDuringABadSampleIsForgottenWithIt) {
  Rested rests;
  rests.claim.expectChange(true);
  ClaimStep bad = at({0, 0, 0}, {0, 0, 0});
  bad.in = HSP_IN_INVALID;
  rests.next(bad);
  unasked(rests, 8);
  EXPECT_FALSE(rests.held) << "the first after a bad sample";
  unasked(rests, -8);
  EXPECT_TRUE(rests.held);
}

TEST(Claim, WhatWasAskedForIsOneChangeOfForceAndTorque) {
  Rested both;
  bool twists = false;
  for (int i = 0; i < 5; ++i) {
    ClaimStep step = at({0, 0, 0}, {0, i % 2 == 0 ? 8.0 : -8.0, 0});
    step.torque = {i % 2 == 0 ? 1.0 : -1.0, 0, 0};
    both.claim.expectChange(true);
    both.claim.checkTorque(step, both.bounds, kTick, twists);
    both.next(step);
    EXPECT_EQ(both.held, i >= 3) << i;
    EXPECT_EQ(twists, i >= 3) << i;
  }
  EXPECT_TRUE(both.claim.excused());
}

}  // namespace
}  // namespace hapticd::servo
