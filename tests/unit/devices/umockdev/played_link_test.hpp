// SPDX-License-Identifier: MIT
/// What the tests of both USB transports share: a kernel that umockdev plays, and an arm that is pushed through a link.
#pragma once
#include <gtest/gtest.h>
#include <umockdev.h>

#include <functional>
#include <string>

#include "base/clock.hpp"
#include "wire_arm/link.hpp"

namespace hapticd::wire_arm {

class PlayedLinkTest : public ::testing::Test {
 protected:
  PlayedLinkTest() : testbed(umockdev_testbed_new()) {}
  ~PlayedLinkTest() override { g_object_unref(testbed); }
  void SetUp() override {
    if (umockdev_in_mock_environment() == FALSE) GTEST_SKIP() << "umockdev's preload library is not in this process";
  }

  /// Pushes at 1 kHz until `done`, or five seconds.
  static bool pushUntil(Link& link, const std::function<bool(const Sample&)>& done) {
    RealClock clock(0);
    Sample sample;
    ArmCommand wanted;
    for (int i = 0; i < 5000; ++i) {
      link.read(sample);
      wanted.time = clock.now(), ++wanted.sequence, wanted.on = true, wanted.torque = {0.1, 0, 0};
      link.write(wanted);
      if (done(sample)) return true;
      clock.waitUntil(clock.now() + 1'000'000);
    }
    return false;
  }

  UMockdevTestbed* testbed;
};

}  // namespace hapticd::wire_arm
