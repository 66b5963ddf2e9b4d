#include "servo/replay.hpp"

#include "servo/servo_watch.hpp"
#include "test_rig.hpp"
#include "watch/watchdog.hpp"

namespace hapticd::servo {
namespace {

void quiet(int, const std::string&, const std::string&) {}

/// A rig whose loop is recorded from its first tick.
struct Recorded : Rig {
  static constexpr uint64_t kTicks = 200;

  Recorded(const char* shape, std::vector<scene::Value> values, const std::vector<scene::Value>& device = {})
      : Rig(
            0, [](Nanoseconds) { return Nanoseconds{0}; }, kTicks, shape, std::move(values), {}, device) {}

  /// Every step takes longer than it may.
  void starve() {
    scene.servo.budget_us = 1e-3;
    WorldOptions options;
    options.measure = options.budgets = true;
    world = std::move(*World::build(scene, options, quiet));
    loop = std::make_unique<Loop>(*world, arms, clock, settings, *telemetry);
  }

  void record() {
    const auto streams = flightStreams(scene, arms, 1000, 1, 0);
    const RunFacts facts{1000, settings.period_ns, settings.ticks, true};
    about = aboutRun(scene, *world, arms, facts, streams);
    telemetry->attach(std::make_unique<Flight>(std::move(*record::FlightRing::create(streams, about)), arms));
    loop->run();
  }

  ReplayOutcome replay() {
    const record::FlightRing& ring = telemetry->flight()->ring();
    auto recording = record::Recording::parse({ring.image(), ring.imageBytes()}, "memory");
    EXPECT_TRUE(recording) << (recording ? "" : recording.error());
    auto run = readAbout(about.json);
    EXPECT_TRUE(run) << (run ? "" : run.error());
    auto replay = Replay::prepare(**recording, std::move(*run), quiet);
    EXPECT_TRUE(replay) << (replay ? "" : replay.error());
    return (*replay)->run();
  }

  record::About about;
};

void expectSame(const ReplayOutcome& outcome) {
  EXPECT_EQ(outcome.ticks, Recorded::kTicks) << outcome.note;
  ASSERT_FALSE(outcome.first) << outcome.first->what << " in tick " << outcome.first->tick << ": "
                              << outcome.first->recorded << ", now " << outcome.first->replayed;
}

TEST(Replay, IsTheSameToTheLastBit) {
  Recorded rig("wall", {});
  rig.record();
  expectSame(rig.replay());
}

#ifndef HAPTICD_SANITIZED  // the watchdog counts processor time, which the sanitizers take too
TEST(Replay, IsTheSameWhereTheWatchdogCutTheMotors) {
  Recorded rig("deadly", {number(0, HSP_ENUM, 5)});
  ServoWatch watched(*rig.loop, *rig.world, rig.arms, *rig.telemetry);
  watch::Watchdog watchdog(watched, [] {});
  ASSERT_FALSE(watchdog.start(81));
  rig.record();
  watchdog.stop();
  ASSERT_EQ(rig.arms[0]->limiter().fault(), Fault::kStuck);
  expectSame(rig.replay());
}
#endif

TEST(Replay, IsTheSameWhereAShapeWasLoweredAndSilencedForItsTime) {
  Recorded rig("wall", {});
  rig.starve();
  rig.record();
  EXPECT_EQ(rig.world->core().models()[0].coarsest, Accuracy::kCoarsest);
  EXPECT_EQ(rig.world->core().models()[0].guard.trouble(), Trouble::kOverrun);
  expectSame(rig.replay());
}

TEST(Replay, IsTheSameThroughEveryFailureOfTheDevice) {
  for (int failure = 1; failure <= 5; ++failure) {
    Recorded rig("wall", {}, {number(2, HSP_ENUM, failure), number(3, HSP_REAL, 0.1)});
    rig.record();
    EXPECT_NE(rig.arms[0]->limiter().fault(), Fault::kNone);
    expectSame(rig.replay());
  }
}

TEST(BlackBox, HasTheSameRowsAsTheShortOneThatItReplaces) {
  Recorded rig("wall", {});
  Rig plain(
      0, [](Nanoseconds) { return Nanoseconds{0}; }, Recorded::kTicks);
  plain.loop->run();
  rig.record();
  const auto expected = plain.telemetry->blackBox(), got = rig.telemetry->blackBox();
  ASSERT_EQ(got.size(), expected.size());
  for (size_t i = 0; i < got.size(); ++i) {
    EXPECT_EQ(got[i].t, expected[i].t);
    EXPECT_EQ(got[i].position, expected[i].position);
    EXPECT_EQ(got[i].force, expected[i].force);
    EXPECT_EQ(got[i].depth_m, expected[i].depth_m);
    EXPECT_EQ(got[i].model, expected[i].model);
    EXPECT_EQ(got[i].status, expected[i].status);
    EXPECT_EQ(got[i].fault, expected[i].fault);
  }
}

}  // namespace
}  // namespace hapticd::servo
