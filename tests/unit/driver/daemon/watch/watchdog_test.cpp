// SPDX-License-Identifier: MIT
#include "watch/watchdog.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fake_servo.hpp"

namespace hapticd::watch {
namespace {

TEST(Watchdog, CutsATickThatDoesNotEndWithinFiveMillisecondsAndOnlyOnce) {
  for (Nanoseconds phase = 0; phase < kMs; phase += kMs / 10) {  // of the checks against the tick
    FakeServo servo;
    Watchdog watchdog(servo, [] {});
    servo.begun = 100 * kMs + phase;
    Nanoseconds cut_at = 0;
    for (Nanoseconds now = 100 * kMs; now < 130 * kMs; now += kMs)
      if (watchdog.check(now)) cut_at = now;
    EXPECT_EQ(servo.cuts, 1);
    EXPECT_LE(cut_at - servo.begun, 5 * kMs);
  }
}

TEST(Watchdog, LeavesAServoAloneThatWaitsOrTicks) {
  FakeServo servo;
  Watchdog watchdog(servo, [] {});
  for (Nanoseconds now = kMs; now < 1000 * kMs; now += kMs) {
    servo.begun = now % (3 * kMs) == 0 ? 0 : now - kMs / 2;
    ++servo.tick;
    EXPECT_FALSE(watchdog.check(now));
  }
  servo.begun = 0;  // a slow rate: it waits for long
  for (Nanoseconds now = 1000 * kMs; now < 2000 * kMs; now += kMs) EXPECT_FALSE(watchdog.check(now));
}

/// A virtual machine charges the servo with the time that it stood still: 28 ms were seen.
TEST(Watchdog, ABusyMachineIsNoFaultOfASimulationButALoopIs) {
  FakeServo servo;
  servo.harmless = true;
  Watchdog watchdog(servo, [] {});
  servo.begun = kMs;
  for (Nanoseconds now = kMs; now < 100 * kMs; now += kMs) EXPECT_FALSE(watchdog.check(now)) << "not scheduled";
  servo.tick = 1;
  servo.begun = 200 * kMs;
  bool cut = false;
  for (Nanoseconds now = 200 * kMs; now < 200 * kMs + 2 * Watchdog::kStuckSimulated; now += kMs) {
    servo.cpu = now - servo.begun;
    cut |= watchdog.check(now);
    EXPECT_FALSE(cut && now < 250 * kMs) << "a machine that stood still";
  }
  EXPECT_TRUE(cut);
}

/// A servo that spins uses its processor, one that sleeps in a plugin does not: with hardware both are cut.
TEST(Watchdog, CutsAPluginThatSpinsAndOneThatSleeps) {
  for (const bool spins : {true, false}) {
    FakeServo servo;
    Watchdog watchdog(servo, [] {});
    Nanoseconds cut_at = 0;
    for (Nanoseconds now = 100 * kMs; now < 130 * kMs; now += kMs) {
      if (now == 110 * kMs) servo.begun = now - kMs / 3;
      if (spins && servo.begun != 0) servo.cpu = now - servo.begun;
      if (watchdog.check(now)) cut_at = now;
    }
    ASSERT_EQ(servo.cuts, 1) << spins;
    EXPECT_LE(cut_at - servo.begun, 5 * kMs) << spins;
  }
}

/// The machine stands still for `stall` in the middle of a tick: watchdog and servo alike, and a virtual machine may
/// charge the servo with the time. Gives how often the motors were cut when the tick then ends `rest` later.
int cutsThroughAStall(bool simulated, Nanoseconds stall, Nanoseconds phase, Nanoseconds rest) {
  FakeServo servo;
  servo.harmless = simulated;
  Watchdog watchdog(servo, [] {});
  Nanoseconds now = 100 * kMs;
  for (; now < 110 * kMs; now += kMs) watchdog.check(now);
  servo.begun = now - kMs + phase;  // between two looks
  const Nanoseconds back = servo.begun + kMs / 50 + stall;
  for (now = std::max(now, back); now < back + rest; now += kMs) {
    servo.cpu = now - servo.begun;
    watchdog.check(now);
  }
  servo.begun = 0;
  for (; now < back + 50 * kMs; now += kMs) watchdog.check(now);
  return servo.cuts;
}

TEST(Watchdog, AMachineThatStoodStillIsNoServoThatIsStuck) {
  for (const bool simulated : {false, true})
    for (const Nanoseconds stall : {3 * kMs, 4 * kMs, 10 * kMs, 150 * kMs, 5000 * kMs})
      for (Nanoseconds phase = 0; phase < kMs; phase += kMs / 10) {
        EXPECT_EQ(cutsThroughAStall(simulated, stall, phase, kMs), 0) << stall << " " << phase;
        EXPECT_EQ(cutsThroughAStall(simulated, stall, phase, simulated ? Watchdog::kStuckSimulated + 5 * kMs : 6 * kMs),
                  1)
            << "stuck after the stall: " << stall;
      }
}

TEST(Watchdog, AfterAStallAServoThatIsStuckIsCutWithinFiveMillisecondsOfLooksOnTime) {
  for (const Nanoseconds jitter : {Nanoseconds{0}, kMs / 10, kMs / 2, kMs}) {
    FakeServo servo;
    Watchdog watchdog(servo, [] {});
    watchdog.check(100 * kMs);
    servo.begun = 100 * kMs + kMs / 5;
    const Nanoseconds back = 120 * kMs;
    Nanoseconds cut_at = 0;
    for (Nanoseconds now = back; cut_at == 0 && now < 140 * kMs; now += kMs + jitter)
      if (watchdog.check(now)) cut_at = now;
    EXPECT_GT(cut_at, back + kMs) << "no moment to end the tick";
    EXPECT_LE(cut_at, back + 5 * kMs);
  }
}

TEST(Watchdog, ThatIsAlwaysLateStillCutsAtItsThirdLook) {
  FakeServo servo;
  Watchdog watchdog(servo, [] {});
  watchdog.check(100 * kMs);
  servo.begun = 101 * kMs;
  int looks = 0;
  for (Nanoseconds now = 110 * kMs; servo.cuts == 0 && looks < 20; now += 10 * kMs, ++looks) watchdog.check(now);
  EXPECT_EQ(looks, 3);
}

/// The servo waits for its next tick, which should have begun at `next`.
Nanoseconds cutOfAWait(FakeServo& servo, Nanoseconds next, Nanoseconds missed_after, int& hung) {
  Watchdog watchdog(servo, [&hung] { ++hung; }, missed_after);
  Nanoseconds cut_at = 0;
  servo.next = next;
  for (Nanoseconds now = 100 * kMs; now < 1200 * kMs; now += kMs)
    if (watchdog.check(now)) cut_at = now;
  return cut_at;
}

TEST(Watchdog, CutsWhenTheNextTickDoesNotComeInTime) {
  for (Nanoseconds phase = 0; phase < kMs; phase += kMs / 10) {
    FakeServo servo;
    int hung = 0;
    const Nanoseconds next = 110 * kMs + phase, cut_at = cutOfAWait(servo, next, Watchdog::kMissedAfter, hung);
    EXPECT_EQ(servo.cuts, 1);
    EXPECT_GT(cut_at, next + Watchdog::kMissedAfter - kMs);
    EXPECT_LE(cut_at, next + 5 * kMs);
    EXPECT_EQ(hung, 0) << "a servo that gets no processor is no thread that hangs";
  }
}

/// What a stuck tick holds, 8.5 N, gives a free tip of 75 g less than 5 mJ in that time.
TEST(Watchdog, CutsWithinThreeMillisecondsOfLooksOnTime) {
  for (Nanoseconds phase = 0; phase < Watchdog::kCheckEvery; phase += Watchdog::kCheckEvery / 10) {
    FakeServo servo;
    Watchdog watchdog(servo, [] {});
    Nanoseconds cut_at = 0;
    for (Nanoseconds now = 100 * kMs; now < 130 * kMs; now += Watchdog::kCheckEvery) {
      if (now == 110 * kMs) servo.begun = now - phase;
      if (watchdog.check(now)) cut_at = now;
    }
    ASSERT_EQ(servo.cuts, 1);
    const double seconds = static_cast<double>(cut_at - servo.begun) * 1e-9;
    EXPECT_LE(8.5 * 8.5 * seconds * seconds / (2 * 0.075), 5e-3) << phase;
  }
}

TEST(Watchdog, EndsAProcessWhoseDeviceNeverComesBackFromItsWait) {
  FakeServo servo;
  servo.runs = ownerOf("arm", "arm", true);
  int hung = 0;
  EXPECT_LE(cutOfAWait(servo, 110 * kMs, Watchdog::kMissedAfter, hung), 115 * kMs);
  EXPECT_EQ(hung, 1);
}

/// Before the first tick no motor is on, and a wait of a simulated arm holds none: both are ended, but not cut.
TEST(Watchdog, EndsAProcessWhoseModuleNeverComesBackWhileNoMotorIsHeld) {
  for (const bool simulated : {false, true})
    for (const bool waits : {false, true}) {
      FakeServo servo;
      servo.harmless = simulated;
      servo.next = simulated && waits ? kMs : 0;
      const Owner module{"arm", "arm", true};
      servo.runs = &module;
      const Nanoseconds most = simulated ? Watchdog::kHungSimulated : Watchdog::kHungAfter;
      int hung = 0;
      Watchdog watchdog(servo, [&hung] { ++hung; });
      const auto look = [&](Nanoseconds time) {
        for (Nanoseconds passed = 0; passed < time; passed += Watchdog::kCheckEvery) watchdog.check(kMs + passed);
      };
      look(most - kMs);
      EXPECT_EQ(hung, 0);
      ++servo.beat;
      look(most - kMs);
      EXPECT_EQ(hung, 0) << "it has come back meanwhile";
      servo.runs = nullptr;
      look(2 * most);
      EXPECT_EQ(hung, 0) << "the daemon itself waits";
      servo.runs = &module;
      look(most + kMs);
      EXPECT_EQ(hung, 1);
      EXPECT_EQ(servo.cuts, 0);
    }
}

TEST(Watchdog, ALateTickIsNoFaultOfASimulationOrOfAMachineThatStoodStill) {
  FakeServo simulation;
  simulation.harmless = true;
  int hung = 0;
  EXPECT_EQ(cutOfAWait(simulation, 110 * kMs, Watchdog::kMissedAfter, hung), 0u);
  for (const Nanoseconds stall : {4 * kMs, 10 * kMs, 150 * kMs, 5000 * kMs}) {
    FakeServo servo;
    Watchdog watchdog(servo, [] {});
    watchdog.check(100 * kMs);
    servo.next = 101 * kMs;
    EXPECT_FALSE(watchdog.check(101 * kMs + stall)) << stall;
    servo.next += stall + kMs;  // it ticks again
    ++servo.tick;
    for (Nanoseconds now = 102 * kMs; now < 120 * kMs; now += kMs) {
      servo.next = 102 * kMs + stall + now;
      EXPECT_FALSE(watchdog.check(now + stall)) << stall;
    }
  }
}

TEST(Watchdog, EndsARunThatWasToldToEndAndDoesNot) {
  FakeServo servo;
  Watchdog watchdog(servo, [] {});
  int late = 0;
  watchdog.onLateEnd([&late] { ++late; });
  for (Nanoseconds now = kMs; now < 2000 * kMs; now += Watchdog::kCheckEvery) watchdog.check(now);
  EXPECT_EQ(late, 0);
  servo.asked = 2000 * kMs;
  for (Nanoseconds now = 2000 * kMs; now < 2800 * kMs; now += Watchdog::kCheckEvery) watchdog.check(now);
  EXPECT_EQ(late, 0);
  for (Nanoseconds now = 2800 * kMs; now < 3000 * kMs; now += Watchdog::kCheckEvery) watchdog.check(now);
  EXPECT_EQ(late, 1);
}

TEST(Watchdog, AVirtualMachineMayTakeLongerForATick) {
  for (const Nanoseconds took : {4 * kMs, 8 * kMs, 15 * kMs}) {
    FakeServo servo;
    Watchdog watchdog(servo, [] {}, Watchdog::kMissedInVirtualMachine, Watchdog::kStuckInVirtualMachine);
    servo.begun = 100 * kMs;
    for (Nanoseconds now = 100 * kMs; now <= 100 * kMs + took; now += kMs) watchdog.check(now);
    EXPECT_EQ(servo.cuts, took > Watchdog::kStuckInVirtualMachine ? 1 : 0) << took;
  }
}

TEST(Watchdog, AVirtualMachineMayBeLateForLonger) {
  FakeServo servo;
  int hung = 0;
  const Nanoseconds cut_at = cutOfAWait(servo, 110 * kMs, Watchdog::kMissedInVirtualMachine, hung);
  EXPECT_GT(cut_at, 155 * kMs);
  EXPECT_LE(cut_at, 165 * kMs);
}

TEST(Watchdog, EndsAServoThatNeverComesBack) {
  FakeServo servo;
  int hung = 0;
  Watchdog watchdog(servo, [&hung] { ++hung; });
  servo.begun = kMs;
  for (Nanoseconds now = kMs; now < 2000 * kMs; now += kMs) watchdog.check(now);
  EXPECT_EQ(hung, 1);
}

/// How many seconds of looks on time it takes until a thread is said to hang that never comes back.
/// @param share of a processor that the servo gets meanwhile
double namedAfter(bool simulated, double share) {
  FakeServo servo;
  servo.harmless = simulated;
  int hung = 0;
  Watchdog watchdog(servo, [&hung] { ++hung; });
  servo.begun = kMs;
  Nanoseconds now = kMs, named = 0;
  for (; now < 20'000 * kMs; now += Watchdog::kCheckEvery) {
    servo.cpu = static_cast<Nanoseconds>(share * static_cast<double>(now - servo.begun));
    watchdog.check(now);
    if (hung == 1 && named == 0) named = now - servo.begun;
  }
  EXPECT_EQ(hung, 1);
  return static_cast<double>(named) * 1e-9;
}

/// A busy machine keeps a simulation waiting for seconds, and whoever it was in would be named, and end the process.
TEST(Watchdog, NamesNobodyForASimulationThatGetsNoProcessor) {
  for (const double share : {0.0, 0.02, 0.09}) {
    EXPECT_GT(namedAfter(true, share), 5) << share;
    EXPECT_LT(namedAfter(true, share), 5.3) << "it never comes back: " << share;
  }
  EXPECT_LT(namedAfter(true, 1), 0.6) << "it spins";
  EXPECT_LT(namedAfter(true, 0.5), 1.1) << "it spins on a busy machine";
  for (const double share : {0.0, 0.5, 1.0}) EXPECT_LT(namedAfter(false, share), 0.51) << "a real arm: " << share;
}

}  // namespace
}  // namespace hapticd::watch
