// SPDX-License-Identifier: MIT
#include "servo/safety/guard.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hapticd::servo {
namespace {

TEST(Guard, JudgesWhatAStepAnswers) {
  const auto judged = [](hsp_status status, bool finite) { return Guard().check(status, finite); };
  EXPECT_EQ(judged(HSP_OK, true), ShapeFault::kNone);
  EXPECT_EQ(judged(HSP_DEGRADED, true), ShapeFault::kNone);
  EXPECT_EQ(judged(HSP_DEGRADED + 1, true), ShapeFault::kBadStatus);
  EXPECT_EQ(judged(HSP_E_NUMERIC, true), ShapeFault::kLost);
  for (const hsp_status status : std::initializer_list<hsp_status>{HSP_E_ARG, HSP_E_STATE, HSP_E_NOMEM, HSP_E_IO, -77})
    EXPECT_EQ(judged(status, true), ShapeFault::kBadStatus) << status;
  EXPECT_EQ(judged(HSP_OK, false), ShapeFault::kNotFinite);
  EXPECT_EQ(judged(HSP_E_NUMERIC, false), ShapeFault::kNotFinite) << "the graver";
}

TEST(Guard, KeepsTheGravestAndForgivesALostSurface) {
  Guard guard;
  EXPECT_EQ(guard.fault(), ShapeFault::kNone);
  EXPECT_FALSE(guard.silenced());
  guard.check(HSP_E_NUMERIC, true);
  EXPECT_EQ(guard.fault(), ShapeFault::kLost);
  EXPECT_FALSE(guard.silenced());
  EXPECT_EQ(guard.enter(ShapeFault::kPulls), ShapeFault::kPulls);
  EXPECT_TRUE(guard.silenced());
  guard.check(HSP_OK, false);
  guard.check(HSP_E_NUMERIC, true);
  EXPECT_EQ(guard.fault(), ShapeFault::kPulls) << "the first that is never forgiven";
}

/// The tick in which the third of `strikes` spread evenly over `ticks` counts; -1: none.
int silencedIn(int between, int strikes) {
  Guard guard;
  for (int tick = 0, struck = 0; tick < 1000 && struck < strikes; ++tick) {
    guard.gain(true, true, 1e-3);
    if (tick % between != 0) continue;
    ++struck;
    if (guard.strike(ShapeFault::kJump, 3) != ShapeFault::kNone) return struck;
  }
  return -1;
}

TEST(Guard, ForgivesTwoStrikesAndNotThreeWithinAHundredTicks) {
  EXPECT_EQ(silencedIn(1, 2), -1);
  EXPECT_EQ(silencedIn(1, 3), 3);
  EXPECT_EQ(silencedIn(49, 3), 3);
  EXPECT_EQ(silencedIn(51, 3), -1) << "the first is forgotten";
  EXPECT_EQ(silencedIn(98, 10), -1);
  Guard guard;
  EXPECT_EQ(guard.strike(ShapeFault::kOverrun, 1), ShapeFault::kOverrun);
  EXPECT_EQ(guard.fault(), ShapeFault::kOverrun);
}

TEST(Guard, TakesAFailedShapeAwayAtOnceAndAnUnwantedOneSlowly) {
  for (const bool good : {false, true}) {
    Guard guard;
    EXPECT_EQ(guard.gain(), 1) << "the first contact needs no fade";
    const double time = good ? Guard::kLeave : Guard::kFadeOut;
    double last = 1;
    int ticks = 0;
    for (; last > 0 && ticks < 1000; ++ticks) {
      const double gain = guard.gain(good, false, 1e-4);
      EXPECT_NEAR(gain, std::max(0.0, last - 1e-4 / time), 1e-12);
      EXPECT_EQ(gain, guard.gain());
      last = gain;
    }
    EXPECT_NEAR(ticks * 1e-4, time, 1.01e-4);
    EXPECT_EQ(guard.gain(good, false, 1e-4), 0) << "and not below";
  }
  EXPECT_LE(Guard::kFadeOut, 0.002) << "8.5 N give an arm of 75 g less than a millijoule";
}

TEST(Guard, LetsAShapeInSlowlyAgain) {
  Guard guard;
  guard.startAtZero();
  EXPECT_EQ(guard.gain(), 0);
  for (int i = 1; i <= 60; ++i)
    EXPECT_NEAR(guard.gain(true, true, 1e-3), std::min(1.0, i * 1e-3 / Guard::kFadeIn), 1e-12);
  EXPECT_EQ(guard.gain(), 1);
}

TEST(Guard, AHundredTicksAreAHundredAfterAnyPeace) {
  for (const int over : {0, 1}) {
    Guard guard;
    for (int i = 0; i < 10; ++i) guard.gain(true, true, 1e-3);
    guard.strike(ShapeFault::kJump, 3);
    for (int i = 0; i < 50; ++i) guard.gain(true, true, 1e-3);
    guard.strike(ShapeFault::kJump, 3);
    for (int i = 0; i < 49 + over; ++i) guard.gain(true, true, 1e-3);
    EXPECT_EQ(guard.strike(ShapeFault::kJump, 3), over == 0 ? ShapeFault::kJump : ShapeFault::kNone);
  }
}

TEST(Guard, ALongPeaceEarnsNothingAndOwesNothing) {
  Guard fresh;
  EXPECT_EQ(fresh.strike(ShapeFault::kJump, 3), ShapeFault::kNone);
  EXPECT_EQ(fresh.strike(ShapeFault::kJump, 3), ShapeFault::kNone) << "in the first tick";
  EXPECT_EQ(fresh.strike(ShapeFault::kJump, 3), ShapeFault::kJump);
  Guard old;
  old.strike(ShapeFault::kJump, 3);
  for (int i = 0; i < 1000; ++i) old.gain(true, true, 1e-3);
  EXPECT_EQ(old.strike(ShapeFault::kJump, 3), ShapeFault::kNone);
  EXPECT_EQ(old.strike(ShapeFault::kJump, 3), ShapeFault::kNone);
  EXPECT_EQ(old.strike(ShapeFault::kJump, 3), ShapeFault::kJump);
}

}  // namespace
}  // namespace hapticd::servo
