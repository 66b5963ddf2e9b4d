#include "servo/loop.hpp"

#include <cmath>
#include <functional>

#include "test_world.hpp"

namespace hapticd::servo {
namespace {

/// What the gantry keeps; the layout of servo_test_device.cpp.
struct GantryLog {
  double force[3];
  uint32_t mode;
  int reads, writes;
};

/// A virtual clock that wakes up late when it is told to.
class LateClock final : public Clock {
 public:
  explicit LateClock(std::function<Nanoseconds(Nanoseconds)> lateness) : lateness_(std::move(lateness)) {
    deadlines.reserve(10000);  // the servo thread must not be charged for the test's own notes
  }
  Nanoseconds now() noexcept HSP_RT override { return now_; }
  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override {
    if (deadline > now_) now_ = deadline;
    now_ += lateness_(deadline);
    deadlines.push_back(deadline);
    return now_;
  }
  std::vector<Nanoseconds> deadlines;

 private:
  std::function<Nanoseconds(Nanoseconds)> lateness_;
  Nanoseconds now_ = 0;
};

/// A wall, a gantry 2 mm inside it, and a loop.
struct Rig {
  explicit Rig(int failure, std::function<Nanoseconds(Nanoseconds)> lateness = [](Nanoseconds) { return 0; },
               uint64_t ticks = 300, const char* shape = "wall")
      : clock(std::move(lateness)) {
    scene.models.push_back(testModel(shape));
    scene.devices.resize(1);
    scene.devices[0].name = scene.devices[0].module = "gantry";
    scene.devices[0].library = TEST_DEVICE;
    scene.devices[0].limits.ramp_in = 0.01;
    scene.devices[0].limits.slew = 0;
    scene.devices[0].parameters = {number(2, HSP_ENUM, failure)};
    world = testWorld(scene);
    auto arm = Arm::open(scene.devices[0], scene.servo, {1000, false}, [](int, const std::string&, const std::string&) {});
    EXPECT_TRUE(arm) << (arm ? "" : arm.error());
    arms.push_back(std::move(*arm));
    EXPECT_TRUE(arms[0]->start(0, Eigen::Vector3d(0, -9.81, 0)));
    hdv_device* handle = arms[0]->device().handle();
    log = static_cast<const GantryLog*>(arms[0]->device().description().extension(handle, "test.log"));
    telemetry = std::make_unique<Telemetry>(scene, 1000);
    settings.ticks = ticks;
    settings.lockstep = true;
    loop = std::make_unique<Loop>(*world, arms, clock, settings, *telemetry);
  }
  scene::Scene scene;
  std::unique_ptr<World> world;
  std::vector<std::unique_ptr<Arm>> arms;
  LateClock clock;
  std::unique_ptr<Telemetry> telemetry;
  LoopSettings settings;
  std::unique_ptr<Loop> loop;
  const GantryLog* log = nullptr;
};

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

TEST(Loop, SkipsWholePeriodsKeepsThePhaseAndCountsThem) {
  // Tick 100 wakes 3.4 periods late: three periods are skipped, the next deadline is on the old grid.
  Rig rig(0, [](Nanoseconds deadline) { return deadline == 100'000'000 ? Nanoseconds{3'400'000} : Nanoseconds{0}; });
  rig.loop->run();
  const record::RunReport report = rig.telemetry->report({});
  EXPECT_EQ(report.overruns, 1u);
  EXPECT_EQ(report.missed_ticks, 3u);
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
  const Fault expected[] = {Fault::kNone, Fault::kDeviceLost, Fault::kNotFinite, Fault::kStale, Fault::kDeviceFault,
                            Fault::kNotCalibrated};
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

TEST(Loop, StopRampsTheForceDownBeforeItEnds) {
  Rig rig(0, [&rig](Nanoseconds deadline) {
    if (deadline == 150'000'000) rig.loop->stop();
    return Nanoseconds{0};
  }, 0);
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
}

#ifndef HAPTICD_SANITIZED  // the sanitizers have an allocator of their own, which is not counted
TEST(Loop, CountsEveryAllocationOfAPlugin) {
  Rig rig(0, [](Nanoseconds) { return Nanoseconds{0}; }, kEnoughTicks, "allocating");
  rig.loop->run();
  EXPECT_GE(rig.telemetry->report({}).servo_allocations, kEnoughTicks / 2);
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
