// SPDX-License-Identifier: MIT
#include "watch/end_watch.hpp"

#include <gtest/gtest.h>

#include "fake_servo.hpp"

namespace hapticd::watch {
namespace {

/// Looks at one tick that takes `looks` looks, in each of which the servo computes for `cpu`.
int hungIn(FakeServo& servo, Nanoseconds looks, Nanoseconds cpu) {
  int hung = 0;
  EndWatch watch(servo, [] {}, [&hung] { ++hung; });
  servo.begun = 0;
  watch.check(1);
  servo.begun = 1;
  servo.cpu += 20 * EndWatch::kHungAfter;  // in the set-up, before the thread had told its clock
  for (Nanoseconds i = 0; i < looks; ++i) watch.check(1), servo.cpu += cpu;
  return hung;
}

TEST(EndWatch, EndsATickThatComputesOnAndOnAndOneThatWaits) {
  constexpr Nanoseconds kLook = EndWatch::kLookEvery, kHung = EndWatch::kHungAfter / kLook;
  FakeServo servo;
  EXPECT_EQ(hungIn(servo, kHung, kLook), 0);
  EXPECT_GT(hungIn(servo, kHung + 2, kLook), 0);
  EXPECT_EQ(hungIn(servo, EndWatch::kWaitsAfter / kLook - 1, 0), 0);
  EXPECT_GT(hungIn(servo, EndWatch::kWaitsAfter / kLook + 2, 0), 0);
}

TEST(EndWatch, EndsWhatDoesNotComeBackAfterTheLastTick) {
  FakeServo servo;
  int stuck = 0;
  EndWatch watch(servo, [] {}, [] { FAIL() << "no tick is to come"; });
  watch.lastCalls([&stuck] { ++stuck; });
  for (Nanoseconds looks = 1; looks < EndWatch::kWaitsForLast / EndWatch::kLookEvery; ++looks) watch.check(looks);
  EXPECT_EQ(stuck, 0);
  watch.check(1), watch.check(2);
  EXPECT_EQ(stuck, 2) << "asked again, as long as nobody is to blame";
}

TEST(EndWatch, EndsAWaitForATickThatDoesNotComeBack) {
  FakeServo servo;
  int hung = 0;
  EndWatch watch(servo, [] {}, [&hung] { ++hung; });
  for (Nanoseconds i = 0; i < EndWatch::kWaitsAfter / EndWatch::kLookEvery - 1; ++i) watch.check(1);
  EXPECT_EQ(hung, 0);
  for (int i = 0; i < 3; ++i) watch.check(1);
  EXPECT_GT(hung, 0);
}

TEST(EndWatch, LeavesSlowTicksAloneHoweverManyThereAre) {
  FakeServo servo;
  int hung = 0;
  EndWatch watch(servo, [] {}, [&hung] { ++hung; });
  for (servo.tick = 0; servo.tick < 20; ++servo.tick)
    for (Nanoseconds looks = 0; looks < 50; ++looks) {
      servo.begun = static_cast<Nanoseconds>(servo.tick) + 1;
      servo.cpu += EndWatch::kLookEvery;
      watch.check(1);
    }
  EXPECT_EQ(hung, 0);
}

}  // namespace
}  // namespace hapticd::watch
