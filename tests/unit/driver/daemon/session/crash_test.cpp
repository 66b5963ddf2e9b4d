// SPDX-License-Identifier: MIT
#include "watch/crash.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>

#include "session/run/watched_servo.hpp"
#include "test_rig.hpp"
#include "watch/quarantine.hpp"
#include "watch/watchdog.hpp"

#ifndef HAPTICD_SANITIZED  // the sanitizers handle these signals themselves

namespace hapticd::servo {
namespace {

namespace fs = std::filesystem;

/// What a daemon does around its loop.
void runWatched(int how, const fs::path& dir) {
  Rig rig(0, [](Nanoseconds) { return Nanoseconds{0}; }, 300, "deadly", {number(0, HSP_ENUM, how)});
  const auto streams = flightStreams(rig.scene, rig.arms, 1000, 1, 0);
  rig.telemetry->attach(
      std::make_unique<Flight>(std::move(*record::FlightRing::create(streams, record::About{})), rig.arms, 8));
  WatchedServo watched(*rig.loop, rig.arms, *rig.telemetry);
  watch::guardAgainstCrash(watched, dir);
  const WorkerScope working(Worker::kServo);
  watch::Watchdog watchdog(watched, [&watched] { watch::endByFault("a step that did not return", watched.inServo()); });
  if (watchdog.start(81)) _exit(3);
  os::prepareSignalStack();
  rig.loop->run();
  _exit(7);  // the plugin should have ended it
}

class CrashDeathTest : public testing::TestWithParam<int> {};

TEST_P(CrashDeathTest, EverySignalOfAPluginEndsWithItsNameItsBlackBoxAndAQuarantine) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::string name = std::array{"SIGSEGV", "SIGFPE", "SIGILL", "SIGBUS"}[static_cast<size_t>(GetParam())];
  const fs::path dir = fs::temp_directory_path() / ("hapticd-crash-" + name);
  fs::remove_all(dir);
  fs::create_directories(dir);
  EXPECT_EXIT(runWatched(GetParam(), dir), testing::ExitedWithCode(1), "plugin 'deadly' of model 'deadly'");
  const auto list = watch::quarantined(dir);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].plugin, "deadly");
  EXPECT_NE(list[0].reason.find(name), std::string::npos) << list[0].reason;
  EXPECT_GT(fs::file_size(dir / "black-box-deadly.flight"), 1000u);
  fs::remove_all(dir);
}
INSTANTIATE_TEST_SUITE_P(Signals, CrashDeathTest, testing::Range(0, 4));

TEST(HangDeathTest, APluginThatNeverComesBackIsEndedByTheWatchdog) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const fs::path dir = fs::temp_directory_path() / "hapticd-crash-hang";
  fs::remove_all(dir);
  fs::create_directories(dir);
  EXPECT_EXIT(runWatched(4, dir), testing::ExitedWithCode(1), "did not return");
  ASSERT_EQ(watch::quarantined(dir).size(), 1u);
  EXPECT_EQ(watch::quarantined(dir)[0].plugin, "deadly");
  fs::remove_all(dir);
}

/// A step that spins on and one that sleeps, on an arm that a hand may hold.
class LateStep : public testing::TestWithParam<int> {};

TEST_P(LateStep, LeavesTheMotorsOffAndAFault) {
  Rig rig(0, [](Nanoseconds) { return Nanoseconds{0}; }, 100, "deadly", {number(0, HSP_ENUM, GetParam())}, {},
          {number(4, HSP_BOOL, 1)});
  WatchedServo watched(*rig.loop, rig.arms, *rig.telemetry);
  watch::Watchdog watchdog(watched, [] {});
  ASSERT_FALSE(watchdog.start(81));
  rig.loop->run();
  watchdog.stop();
  EXPECT_GE(watchdog.cuts(), 1u);  // and again where a busy machine lets the next tick be late too
  EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kStuck);
  EXPECT_EQ(rig.log->mode, static_cast<uint32_t>(HDV_OFF));
  for (const BlackBoxRow& row : rig.telemetry->blackBox()) {
    if (row.t > 0.0105) {
      EXPECT_EQ(row.force[1], 0) << row.t;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(SpinningAndSleeping, LateStep, testing::Values(5, 7));

TEST(Watch, AForceBeyondTheClaimIsNotFeltAndItsShapeIsSilenced) {
  Rig rig(0, [](Nanoseconds) { return Nanoseconds{0}; }, 300, "deadly", {number(0, HSP_ENUM, 6)});
  rig.loop->run();
  EXPECT_EQ(rig.world->core().models()[0].guard.fault(), ShapeFault::kJump);
  for (const BlackBoxRow& row : rig.telemetry->blackBox()) EXPECT_LE(row.force[1], 1 + 2 * Claim::kStep);
}

}  // namespace
}  // namespace hapticd::servo

#endif
