// SPDX-License-Identifier: MIT
/// A loop in virtual time over a gantry and one shape.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "servo/loop/loop.hpp"
#include "session/telemetry/telemetry.hpp"
#include "test_world.hpp"

namespace hapticd::servo {

/// What the gantry keeps; the layout of servo_test_device.cpp.
struct GantryLog {
  double force[3];
  uint32_t mode;
  int reads, writes;
  bool only_numbers;      ///< no command ever had anything else
  std::atomic<int> hold;  ///< 1 keeps the next write inside the module, which makes it 2, until it is 0
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
    if (deadlines.size() < deadlines.capacity()) deadlines.push_back(deadline);
    return now_;
  }
  std::vector<Nanoseconds> deadlines;

 private:
  std::function<Nanoseconds(Nanoseconds)> lateness_;
  Nanoseconds now_ = 0;
};

/// A wall, a gantry 2 mm inside it, and a loop.
struct Rig {
  explicit Rig(
      int failure, std::function<Nanoseconds(Nanoseconds)> lateness = [](Nanoseconds) { return 0; },
      uint64_t ticks = 300, const char* shape = "wall", std::vector<scene::Value> values = {},
      const std::vector<scene::Model>& more = {}, const std::vector<scene::Value>& device = {},
      const std::function<void(scene::Limits&)>& limit = [](scene::Limits&) {}, const scene::Clients& clients = {})
      : clock(std::move(lateness)) {
    scene.models.push_back(testModel(shape, std::move(values)));
    scene.models.insert(scene.models.end(), more.begin(), more.end());
    scene.clients = clients;
    scene.devices.resize(1);
    scene.devices[0].name = scene.devices[0].module = "gantry";
    scene.devices[0].library = TEST_DEVICE;
    scene.devices[0].limits.ramp_in = 0.01;
    scene.devices[0].limits.slew = 0;
    scene.devices[0].parameters = {number(2, HSP_ENUM, failure)};
    scene.devices[0].parameters.insert(scene.devices[0].parameters.end(), device.begin(), device.end());
    limit(scene.devices[0].limits);
    world = testWorld(scene);
    auto arm = Arm::open(scene.devices[0], scene.servo, {1000, false, nullptr, clients},
                         [](int, const std::string&, const std::string&) {});
    EXPECT_TRUE(arm) << (arm ? "" : arm.error());
    arms.push_back(std::move(*arm));
    EXPECT_TRUE(arms[0]->start(0, Eigen::Vector3d(0, -9.81, 0)));
    hdv_device* handle = arms[0]->device().handle();
    log = static_cast<GantryLog*>(const_cast<void*>(arms[0]->device().description().extension(handle, "test.log")));
    telemetry = std::make_unique<Telemetry>(scene, 1000);
    settings.ticks = ticks;
    settings.lockstep = true;
    loop = std::make_unique<Loop>(world->core(), world->lockstep(), arms, clock, settings, *telemetry);
  }
  scene::Scene scene;
  std::unique_ptr<World> world;
  Arms arms;
  LateClock clock;
  std::unique_ptr<Telemetry> telemetry;
  LoopSettings settings;
  std::unique_ptr<Loop> loop;
  GantryLog* log = nullptr;
};

}  // namespace hapticd::servo
