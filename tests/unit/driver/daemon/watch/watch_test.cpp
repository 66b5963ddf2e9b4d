// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>

#include "watch/crash.hpp"
#include "watch/end_watch.hpp"
#include "watch/notify.hpp"
#include "watch/quarantine.hpp"
#include "watch/watchdog.hpp"

namespace hapticd::watch {
namespace {

struct Fake : WatchTarget {
  uint64_t tick = 0;
  Nanoseconds begun = 0, next = 0, cpu = 0, asked = 0;
  bool harmless = false;
  int cuts = 0;
  const Owner* runs = nullptr;  ///< whose code the servo is in
  uint64_t ticks() const noexcept override { return tick; }
  Nanoseconds tickBegun() const noexcept override { return begun; }
  Nanoseconds nextTick() const noexcept override { return next; }
  Nanoseconds cpuTime() const noexcept override { return cpu; }
  bool simulated() const noexcept override { return harmless; }
  void cut(double) noexcept override { ++cuts; }
  void stop() noexcept override {}
  Nanoseconds stopAsked() const noexcept override { return asked; }
  bool cutLeft() const noexcept override { return true; }
  const Owner* inServo() const noexcept override { return runs; }
  const void* blackBox() const noexcept override { return nullptr; }
  size_t blackBoxBytes() const noexcept override { return 0; }
};

constexpr Nanoseconds kMs = 1'000'000;

TEST(Watchdog, CutsATickThatDoesNotEndWithinFiveMillisecondsAndOnlyOnce) {
  for (Nanoseconds phase = 0; phase < kMs; phase += kMs / 10) {  // of the checks against the tick
    Fake servo;
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
  Fake servo;
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
  Fake servo;
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
    Fake servo;
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
  Fake servo;
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
    Fake servo;
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
  Fake servo;
  Watchdog watchdog(servo, [] {});
  watchdog.check(100 * kMs);
  servo.begun = 101 * kMs;
  int looks = 0;
  for (Nanoseconds now = 110 * kMs; servo.cuts == 0 && looks < 20; now += 10 * kMs, ++looks) watchdog.check(now);
  EXPECT_EQ(looks, 3);
}

/// The servo waits for its next tick, which should have begun at `next`.
Nanoseconds cutOfAWait(Fake& servo, Nanoseconds next, Nanoseconds missed_after, int& hung) {
  Watchdog watchdog(servo, [&hung] { ++hung; }, missed_after);
  Nanoseconds cut_at = 0;
  servo.next = next;
  for (Nanoseconds now = 100 * kMs; now < 1200 * kMs; now += kMs)
    if (watchdog.check(now)) cut_at = now;
  return cut_at;
}

TEST(Watchdog, CutsWhenTheNextTickDoesNotComeInTime) {
  for (Nanoseconds phase = 0; phase < kMs; phase += kMs / 10) {
    Fake servo;
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
    Fake servo;
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
  Fake servo;
  servo.runs = ownerOf("arm", "arm", true);
  int hung = 0;
  EXPECT_LE(cutOfAWait(servo, 110 * kMs, Watchdog::kMissedAfter, hung), 115 * kMs);
  EXPECT_EQ(hung, 1);
}

TEST(Watchdog, ALateTickIsNoFaultOfASimulationOrOfAMachineThatStoodStill) {
  Fake simulation;
  simulation.harmless = true;
  int hung = 0;
  EXPECT_EQ(cutOfAWait(simulation, 110 * kMs, Watchdog::kMissedAfter, hung), 0u);
  for (const Nanoseconds stall : {4 * kMs, 10 * kMs, 150 * kMs, 5000 * kMs}) {
    Fake servo;
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
  Fake servo;
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
    Fake servo;
    Watchdog watchdog(servo, [] {}, Watchdog::kMissedInVirtualMachine, Watchdog::kStuckInVirtualMachine);
    servo.begun = 100 * kMs;
    for (Nanoseconds now = 100 * kMs; now <= 100 * kMs + took; now += kMs) watchdog.check(now);
    EXPECT_EQ(servo.cuts, took > Watchdog::kStuckInVirtualMachine ? 1 : 0) << took;
  }
}

TEST(Watchdog, AVirtualMachineMayBeLateForLonger) {
  Fake servo;
  int hung = 0;
  const Nanoseconds cut_at = cutOfAWait(servo, 110 * kMs, Watchdog::kMissedInVirtualMachine, hung);
  EXPECT_GT(cut_at, 155 * kMs);
  EXPECT_LE(cut_at, 165 * kMs);
}

TEST(Watchdog, EndsAServoThatNeverComesBack) {
  Fake servo;
  int hung = 0;
  Watchdog watchdog(servo, [&hung] { ++hung; });
  servo.begun = kMs;
  for (Nanoseconds now = kMs; now < 2000 * kMs; now += kMs) watchdog.check(now);
  EXPECT_EQ(hung, 1);
}

/// How many seconds of looks on time it takes until a thread is said to hang that never comes back.
/// @param share of a processor that the servo gets meanwhile
double namedAfter(bool simulated, double share) {
  Fake servo;
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

#ifndef HAPTICD_SANITIZED  // the sanitizers handle these signals themselves

/// A device whose cut crashes, or never comes back.
struct BadCut : Fake {
  bool hangs = false;
  void cut(double) noexcept override {
    while (hangs) pause();
    std::raise(SIGSEGV);
  }
};

TEST(CrashDeathTest, OneInsideTheCutOfTheMotorsStillEndsInQuarantine) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::filesystem::path dir = std::filesystem::temp_directory_path() / "hapticd-bad-cut";
  std::filesystem::remove_all(dir);
  std::filesystem::create_directories(dir);
  const auto crash = [&] {
    BadCut servo;
    guardAgainstCrash(servo, dir);
    const OwnerScope calling(ownerOf("bad", "model"));
    std::raise(SIGFPE);
  };
  EXPECT_EXIT(crash(), testing::ExitedWithCode(1), "SIGFPE.*\n.*switching the motors off crashed too");
  ASSERT_EQ(quarantined(dir).size(), 1u);
  EXPECT_EQ(quarantined(dir)[0].plugin, "bad");
  std::filesystem::remove_all(dir);
}

TEST(CrashDeathTest, ACutThatNeverComesBackIsEndedByTheNextThreadThatMissesTheServo) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto crash = [] {
    BadCut servo;
    servo.hangs = true;
    guardAgainstCrash(servo, "");
    std::thread servo_thread([] { std::raise(SIGFPE); });
    usleep(100'000);
    endByFault("a step that did not come back", nullptr);
  };
  EXPECT_EXIT(crash(), testing::ExitedWithCode(1), "");
}

#endif

TEST(Notify, FeedsTheServiceManagerOnlyWhileTicksMove) {
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = (std::filesystem::temp_directory_path() / ("notify" + std::to_string(getpid()))).string();
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  unlink(path.c_str());
  ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);
  setenv("WATCHDOG_USEC", "2000000", 1);
  Feeder feeder;
  EXPECT_TRUE(feeder.feed(10'000 * kMs, 5));
  char got[64] = "";
  EXPECT_EQ(recv(fd, got, sizeof got, 0), 10);
  EXPECT_STREQ(got, "WATCHDOG=1");
  EXPECT_FALSE(feeder.feed(20'000 * kMs, 5)) << "the servo stands still";
  EXPECT_TRUE(feeder.feed(20'000 * kMs, 6));
  unsetenv("NOTIFY_SOCKET");
  unsetenv("WATCHDOG_USEC");
  EXPECT_FALSE(notify("READY=1"));
  close(fd);
  unlink(path.c_str());
}

/// Looks at one tick that takes `looks` looks, in each of which the servo computes for `cpu`.
int hungIn(Fake& servo, Nanoseconds looks, Nanoseconds cpu) {
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
  Fake servo;
  EXPECT_EQ(hungIn(servo, kHung, kLook), 0);
  EXPECT_GT(hungIn(servo, kHung + 2, kLook), 0);
  EXPECT_EQ(hungIn(servo, EndWatch::kWaitsAfter / kLook - 1, 0), 0);
  EXPECT_GT(hungIn(servo, EndWatch::kWaitsAfter / kLook + 2, 0), 0);
}

TEST(EndWatch, EndsWhatDoesNotComeBackAfterTheLastTick) {
  Fake servo;
  int stuck = 0;
  EndWatch watch(servo, [] {}, [] { FAIL() << "no tick is to come"; });
  watch.lastCalls([&stuck] { ++stuck; });
  for (Nanoseconds looks = 1; looks < EndWatch::kWaitsForLast / EndWatch::kLookEvery; ++looks) watch.check(looks);
  EXPECT_EQ(stuck, 0);
  watch.check(1), watch.check(2);
  EXPECT_EQ(stuck, 2) << "asked again, as long as nobody is to blame";
}

TEST(EndWatch, LeavesSlowTicksAloneHoweverManyThereAre) {
  Fake servo;
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
