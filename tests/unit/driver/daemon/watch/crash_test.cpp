// SPDX-License-Identifier: MIT
#include "watch/crash.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <thread>

#include "fake_servo.hpp"
#include "watch/quarantine.hpp"

#ifndef HAPTICD_SANITIZED  // the sanitizers handle these signals themselves
namespace hapticd::watch {
namespace {

/// A device whose cut crashes, or never comes back.
struct BadCut : FakeServo {
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
    endByFault("a step that did not return", nullptr);
  };
  EXPECT_EXIT(crash(), testing::ExitedWithCode(1), "");
}

}  // namespace
}  // namespace hapticd::watch

#endif
