// SPDX-License-Identifier: MIT
#include "servo/loop/loop.hpp"

#include "base/allocation_owner.hpp"
#include "record/allocation_text.hpp"
#include "test_rig.hpp"

namespace hapticd::servo {
namespace {

TEST(Loop, TicksOncePerPeriodAndEndsWithZeroForce) {
  Rig rig(0);
  rig.loop->run();
  const record::RunReport report = rig.telemetry->report({});
  EXPECT_EQ(report.ticks, 300u);
  EXPECT_EQ(report.overruns, 0u);
  EXPECT_EQ(rig.log->writes, 300);
  EXPECT_EQ(rig.log->force[1], 0);
  EXPECT_NEAR(report.models[0].contact.meanDepth(), 0.002, 1e-12);
  EXPECT_NEAR(report.models[0].contact.meanForce(), 2.0, 1e-9);
  EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kStopped);
}

/// A hand goes against a program's push of 2 N. A spring of a program may give this work back, so it is no debt.
TEST(Loop, WhatAHandPutIntoAProgramsPushIsKept) {
  Rig* self = nullptr;
  link::PushSlot slot;
  double kept = 0;
  const auto answer = [&self, &slot, &kept, tick = uint64_t{0}](Nanoseconds) mutable {
    hapticd_push push{};
    push.tick = tick++;
    push.force[0] = -2;
    slot.put(push);
    if (push.tick == 200) kept = self->arms[0]->passivity()->energy();
    return Nanoseconds{0};
  };
  Rig rig(7, answer, 300, "wall", {}, {},  // it moves along x at 0.3 m/s from 0.05 s on, above the wall
          {number(0, HSP_REAL, -0.01), number(5, HSP_REAL, 0.3)}, [](scene::Limits&) {},
          {.mode = scene::ClientMode::kAdd, .max_force = 3});
  self = &rig;
  ASSERT_NE(rig.arms[0]->passivity(), nullptr);
  rig.arms[0]->clients().begin(0, slot);
  rig.loop->run();
  EXPECT_NEAR(kept, 2 * 0.3 * 0.15, 0.01);
}

TEST(Loop, DryCyclesPushNothingAndLeaveTheRunAsItIs) {
  Rig plain(0),
      dry(0, [](Nanoseconds deadline) { return deadline == 50'000'000 ? Nanoseconds{2'500'000} : Nanoseconds{0}; });
  plain.loop->run();
  dry.settings.dry_cycles = 2000;
  Loop loop(dry.world->core(), dry.world->lockstep(), dry.arms, dry.clock, dry.settings, *dry.telemetry);
  loop.run();
  EXPECT_EQ(dry.log->writes, 2300);
  EXPECT_EQ(loop.lateDryCycles(), 1u);
  const auto expected = plain.telemetry->blackBox(), got = dry.telemetry->blackBox();
  ASSERT_EQ(got.size(), expected.size());
  for (size_t i = 0; i < got.size(); ++i) EXPECT_EQ(got[i].force, expected[i].force) << i;
}

TEST(Loop, SkipsWholePeriodsKeepsThePhaseAndCountsThem) {
  // Tick 100 wakes 3.4 periods late: three periods are skipped, the next deadline is on the old grid.
  Rig rig(0, [](Nanoseconds deadline) { return deadline == 100'000'000 ? Nanoseconds{3'400'000} : Nanoseconds{0}; });
  rig.loop->run();
  const record::RunReport report = rig.telemetry->report({});
  EXPECT_EQ(report.overruns, 1u);
  EXPECT_EQ(report.missed_ticks, 3u);
  EXPECT_EQ(report.lateness_us.max(), 3400) << "how late it woke, not how late in the period it then took";
  EXPECT_EQ(report.ticks, 297u);
  for (const Nanoseconds deadline : rig.clock.deadlines) EXPECT_EQ(deadline % 1'000'000, 0u);
  EXPECT_EQ(rig.clock.deadlines[101], 104'000'000u);
}

TEST(Loop, LatenessBelowAPeriodIsBookedAndCostsNoTick) {
  Rig rig(0, [](Nanoseconds) { return Nanoseconds{40'000}; });
  rig.loop->run();
  const record::RunReport report = rig.telemetry->report({});
  EXPECT_EQ(report.overruns, 0u);
  EXPECT_EQ(report.ticks, 300u);
  EXPECT_NEAR(report.lateness_us.quantile(0.5), 40, 1);
}

TEST(Loop, EveryFailureOfTheDeviceEndsInZeroForceWithItsName) {
  const Fault expected[] = {Fault::kNone,  Fault::kDeviceLost,  Fault::kNotFinite,
                            Fault::kStale, Fault::kDeviceFault, Fault::kNotCalibrated};
  for (int failure = 1; failure <= 5; ++failure) {
    Rig rig(failure);
    rig.loop->run();
    EXPECT_EQ(rig.arms[0]->limiter().fault(), expected[failure]);
    EXPECT_EQ(rig.log->mode, static_cast<uint32_t>(HDV_OFF));
    EXPECT_EQ(rig.log->writes, 300) << "the loop stays up: other arms and the user still need it";
    const std::vector<BlackBoxRow> rows = rig.telemetry->blackBox();
    for (size_t i = 0; i < rows.size(); ++i) {
      const double allowed = failure == 3 ? 0.05 + 0.05 + 0.021 : 0.05 + 0.021;  // stale is noticed after 50 ms
      if (rows[i].t > allowed) {
        EXPECT_EQ(rows[i].force[1], 0) << describe(expected[failure]) << " at " << rows[i].t;
      }
    }
  }
}

TEST(Loop, AJacobianThatIsNoNumberIsAFaultAndItsForceIsNotCalledSent) {
  Rig rig(12);
  rig.loop->run();
  EXPECT_EQ(rig.arms[0]->limiter().fault(), Fault::kNotFinite);
  EXPECT_TRUE(rig.log->only_numbers);
  const std::vector<BlackBoxRow> rows = rig.telemetry->blackBox();
  double before = 0;
  for (const auto& row : rows) {
    if (row.t < 0.05)
      before = row.force[1];
    else
      EXPECT_EQ(row.force[1], 0) << row.t;
  }
  EXPECT_GT(before, 1);
}

TEST(Loop, StopRampsTheForceDownBeforeItEnds) {
  Rig rig(
      0,
      [&rig](Nanoseconds deadline) {
        if (deadline == 150'000'000) rig.loop->stop();
        return Nanoseconds{0};
      },
      0);
  rig.loop->run();
  EXPECT_NEAR(static_cast<double>(rig.loop->ticks()), 172, 2);
  double last = 2;
  for (const BlackBoxRow& row : rig.telemetry->blackBox()) {
    if (row.t < 0.15) continue;
    EXPECT_LE(row.force[1], last + 1e-6);
    last = static_cast<double>(row.force[1]);
  }
  EXPECT_EQ(last, 0);
}

/// Ticks after the warm-up; the report counts from there.
constexpr uint64_t kEnoughTicks = 1000;

TEST(Loop, ServoPathAllocatesNothing) {
  Rig rig(0, [](Nanoseconds) { return Nanoseconds{0}; }, kEnoughTicks);
  rig.loop->run();
  EXPECT_EQ(rig.telemetry->report({}).servo_allocations, 0u);
  EXPECT_EQ(record::allocationText(rig.telemetry->report({}), {}), "");
}

#ifndef HAPTICD_SANITIZED  // the sanitizers have an allocator of their own, which is not counted
TEST(Loop, CountsEveryAllocationOfAPlugin) {
  Rig rig(0, [](Nanoseconds) { return Nanoseconds{0}; }, kEnoughTicks, "allocating");
  rig.loop->run();
  const record::RunReport report = rig.telemetry->report({});
  EXPECT_GE(report.servo_allocations, kEnoughTicks / 2);
  const AllocationShare most = mostAllocations();
  ASSERT_NE(most.owner, nullptr);
  EXPECT_EQ(most.owner->module, "allocating");
  EXPECT_GE(most.count, kEnoughTicks / 2);
  const std::string told = record::allocationText(report, most);
  EXPECT_NE(told.find(" mostly in the plugin allocating ("), std::string::npos) << told;
  EXPECT_NE(told.find("fix: allocate the memory in activate()"), std::string::npos) << told;
}
#endif

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
TEST(LoopDeathTest, RealTimeSanitizerStopsAPluginThatAllocates) {
  EXPECT_DEATH(
      {
        Rig rig(0, [](Nanoseconds) { return Nanoseconds{0}; }, 10, "allocating");
        rig.loop->run();
      },
      "RealtimeSanitizer");
}
#endif
#endif

}  // namespace
}  // namespace hapticd::servo
