// SPDX-License-Identifier: MIT
/// What ends by itself: a device that was gone, silent, at fault or without its zero gets its force back in a ramp,
/// half a second after it is well. What the user or the daemon is to blame for stays off until it is cleared.
#include <gtest/gtest.h>

#include "test_rig.hpp"

namespace hapticd::servo {
namespace {

constexpr uint64_t kTicks = 1500;
enum Failure { kLost = 1, kNotANumber = 2, kSilent = 3, kAtFault = 4, kUncalibrated = 5 };

scene::Value at(uint32_t index, double seconds) {
  return number(index, HSP_REAL, seconds);
}

/// Fails from 0.05 to 0.3 s.
struct Recovering : Rig {
  explicit Recovering(
      int failure, std::function<Nanoseconds(Nanoseconds)> tick = [](Nanoseconds) { return 0; },
      const std::vector<scene::Value>& more = {})
      : Rig(failure, std::move(tick), kTicks, "wall", {}, {}, joined({at(3, 0.3)}, more)) {}
  static std::vector<scene::Value> joined(std::vector<scene::Value> values, const std::vector<scene::Value>& more) {
    values.insert(values.end(), more.begin(), more.end());
    return values;
  }
  double forceAt(double t) const {
    for (const BlackBoxRow& row : telemetry->blackBox())
      if (std::abs(row.t - t) < 2e-4) return static_cast<double>(row.force[1]);
    return std::nan("");
  }
};

class Recovery : public ::testing::TestWithParam<int> {};

TEST_P(Recovery, ComesInARampHalfASecondAfterTheDeviceIsWell) {
  Recovering rig(GetParam());
  rig.loop->run();
  EXPECT_EQ(rig.forceAt(0.25), 0);
  EXPECT_EQ(rig.forceAt(0.75), 0) << "well for too short a time";
  EXPECT_NEAR(rig.forceAt(0.9), 2, 1e-6);
  EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kStopped) << "by the end of the run";
  EXPECT_TRUE(endsByItself(rig.arms[0]->limiter().recovered()));
  double before = 0;
  for (const BlackBoxRow& row : rig.telemetry->blackBox()) {
    const auto now = static_cast<double>(row.force[1]);
    if (row.t > 0.3 && row.t < 1) {
      EXPECT_LE(now, before + 0.21) << "a ramp of 10 ms to 2 N, at " << row.t;
    }
    before = now;
  }
}
INSTANTIATE_TEST_SUITE_P(Each, Recovery, ::testing::Values(kLost, kSilent, kAtFault, kUncalibrated));

TEST(RecoveryTest, AForceComesBackOnlyIfTheTipRestsOrNoForceActs) {
  const auto onTime = [](Nanoseconds) { return Nanoseconds{0}; };
  const scene::Value fast = at(5, 0.1), outside = at(0, -0.01);
  Recovering pressed(kLost, onTime, {fast});
  pressed.loop->run();
  EXPECT_EQ(pressed.arms[0]->limiter().recovered(), Fault::kNone) << "5 cm in the half second";
  EXPECT_EQ(pressed.forceAt(1.2), 0);
  Recovering slow(kLost, onTime, {at(5, 0.03)});
  slow.loop->run();
  EXPECT_EQ(slow.arms[0]->limiter().recovered(), Fault::kDeviceLost) << "1.5 cm in the half second";
  Recovering free(kLost, onTime, {fast, outside});
  free.loop->run();
  EXPECT_EQ(free.arms[0]->limiter().recovered(), Fault::kDeviceLost);
}

TEST(RecoveryTest, WhatWasNotANumberStaysOff) {
  Recovering rig(kNotANumber);
  rig.loop->run();
  EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kNotFinite);
  EXPECT_EQ(rig.forceAt(1.2), 0);
}

TEST(RecoveryTest, AHoldDuringTheFaultHoldsAfterIt) {
  Rig* self = nullptr;
  Recovering rig(kLost, [&self](Nanoseconds deadline) {
    if (deadline == 100'000'000) self->arms[0]->limiter().trip(Fault::kStopped);
    return Nanoseconds{0};
  });
  self = &rig;
  rig.loop->run();
  EXPECT_EQ(rig.forceAt(1.2), 0);
  EXPECT_EQ(rig.arms[0]->limiter().recovered(), Fault::kNone);
}

TEST(RecoveryTest, AGraverFaultTakesThePlaceOfOneThatEndsByItself) {
  Rig rig(0);
  for (int i = 0; i < 20; ++i) {
    rig.arms[0]->limiter().trip(Fault::kDeviceLost);
    EXPECT_TRUE(endsByItself(rig.arms[0]->limiter().fault()));
  }
  rig.arms[0]->limiter().trip(Fault::kStuck);
  EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kStuck) << "graver";
  rig.arms[0]->limiter().recover();
  EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kStuck) << "does not end by itself";
}

TEST(RecoveryTest, TheDevicesOwnWordsAreTheMessage) {
  const std::string text = faultMessage("arm", Fault::kDeviceFault, 0, "a stalled endpoint; unplug it");
  EXPECT_EQ(text,
            "device arm: a stalled endpoint; its forces ended and come back in a ramp once the device works again; "
            "unplug it");
  EXPECT_NE(faultMessage("arm", Fault::kNotFinite, 0).find("until the fault is cleared"), std::string::npos);
}

}  // namespace
}  // namespace hapticd::servo
