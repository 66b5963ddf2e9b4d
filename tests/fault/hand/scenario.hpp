// SPDX-License-Identifier: MIT
/// A loop in virtual time over the test arm `rig`, which counts as real hardware: what a hostile shape, scene or device
/// makes the motors do.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rig_page.hpp"
#include "servo/loop/loop.hpp"
#include "session/telemetry/telemetry.hpp"
#include "world/arm_force.hpp"
#include "world/world.hpp"

namespace hapticd::servo {

inline scene::Value value(uint32_t index, uint32_t kind, double number) {
  scene::Value v;
  v.index = index;
  v.kind = kind;
  v.number = number;
  return v;
}

/// A model of the hostile shapes: its plugin and its numbers, each `{index, kind, value}`.
inline scene::Model hostile(const std::string& plugin, std::vector<scene::Value> parameters = {}) {
  scene::Model model;
  model.name = model.plugin = plugin;
  model.library = TEST_HOSTILE;
  model.parameters = std::move(parameters);
  return model;
}

constexpr uint32_t kRigRate = 4;  ///< of the parameters of the rig

/// Virtual time that calls the test before every tick.
class ScriptedClock final : public Clock {
 public:
  using Script = std::function<Nanoseconds(Nanoseconds)>;  ///< deadline in, how much later it wakes out
  explicit ScriptedClock(Script script) : script_(std::move(script)) {}
  Nanoseconds now() noexcept HSP_RT override { return now_; }
  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override {
    now_ = std::max(now_, deadline);
    return now_ += script_(deadline);
  }

 private:
  Script script_;
  Nanoseconds now_ = 0;
};

struct Settings {
  double rate = 1000;
  double arm_rate = 1000;  ///< that the arm names
  std::vector<scene::Model> models;
  std::function<void(scene::Limits&)> limit = [](scene::Limits&) {};
  Eigen::Quaterniond mount = Eigen::Quaterniond::Identity();
  bool full_when_slow = false;  ///< of ArmOptions
};

/// One command that left for the motors, or a cut.
struct Sent {
  double t = 0;  ///< [s] since the first tick
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
};

class Scenario {
 public:
  using Before = std::function<Nanoseconds(double t)>;  ///< before the tick at t [s]; how much later it wakes

  explicit Scenario(const Settings& settings) {
    scene_.servo.rate = settings.rate;
    scene_.models = settings.models;
    scene_.devices.resize(1);
    scene::Device& device = scene_.devices[0];
    device.name = device.module = "rig";
    device.library = TEST_RIG;
    device.mount.orientation = settings.mount;
    device.parameters = {value(kRigRate, HSP_REAL, settings.arm_rate)};
    device.limits.ramp_in = 0.01;
    settings.limit(device.limits);
    const auto silent = [](int, const std::string&, const std::string&) {};
    auto world = World::build(scene_, {settings.rate, 1, 0, false, false, 0, maxForceOf(scene_)}, silent);
    if (!world) throw std::runtime_error(world.error());
    world_ = std::move(*world);
    auto arm = Arm::open(device, scene_.servo,
                         {settings.rate, world_->needsVelocity(), nullptr, {}, false, settings.full_when_slow}, silent);
    if (!arm) throw std::runtime_error(arm.error());
    arms_.push_back(std::move(*arm));
    page_ = static_cast<rig::Page*>(const_cast<void*>(
        arms_[0]->device().description().extension(arms_[0]->device().handle(), rig::kPageExtension)));
    if (auto started = arms_[0]->start(0, scene_.servo.gravity); !started) throw std::runtime_error(started.error());
    telemetry_ = std::make_unique<Telemetry>(scene_, settings.rate);
  }

  rig::Wishes& wishes() { return page_->wishes; }
  void moveTo(const Eigen::Vector3d& position) { Eigen::Map<Eigen::Vector3d>(wishes().position) = position; }
  Arm& arm() { return *arms_[0]; }
  Core& core() { return world_->core(); }
  Telemetry& telemetry() { return *telemetry_; }
  Loop& loop() { return *loop_; }
  bool motorsOn() const { return page_->motors.on.load() != 0; }                      ///< as of now
  double motorForce() const { return Eigen::Vector3d(page_->motors.torque).norm(); }  ///< [N] the same
  Fault fault() { return arm().limiter().fault(); }
  ShapeFault trouble(uint32_t model = 0) { return core().models()[model].guard.fault(); }

  /// Runs for so many seconds and gives what was sent, each tick's command; without the ramp at the end of the run.
  std::vector<Sent> run(double seconds, const Before& before = [](double) { return Nanoseconds{0}; }) {
    ScriptedClock clock([&before](Nanoseconds deadline) { return before(static_cast<double>(deadline) * 1e-9); });
    LoopSettings settings;
    settings.period_ns = static_cast<Nanoseconds>(1e9 / scene_.servo.rate);
    constexpr double kEnd = 0.05;
    settings.ticks = static_cast<uint64_t>((seconds + kEnd) * scene_.servo.rate);
    settings.lockstep = true;
    loop_ = std::make_unique<Loop>(world_->core(), world_->lockstep(), arms_, clock, settings, *telemetry_);
    loop_->run();
    std::vector<Sent> sent;
    for (uint64_t i = 0; i < page_->count.load(); ++i) {
      const rig::Entry& entry = page_->entry(i);
      // A cut is told no time: it came in the tick after the last command.
      const double t = entry.kind == rig::kCut && !sent.empty() ? sent.back().t + 1 / scene_.servo.rate
                                                                : static_cast<double>(entry.given_ns) * 1e-9;
      if ((entry.kind == rig::kCommand || entry.kind == rig::kCut) && t < seconds)
        sent.push_back({t, Eigen::Vector3d(entry.torque)});
    }
    return sent;
  }

 private:
  scene::Scene scene_;
  std::unique_ptr<World> world_;
  Arms arms_;
  std::unique_ptr<Telemetry> telemetry_;
  std::unique_ptr<Loop> loop_;
  rig::Page* page_ = nullptr;
};

/// [N] The largest force that was sent.
inline double largest(const std::vector<Sent>& sent) {
  double most = 0;
  for (const Sent& s : sent) most = std::max(most, s.force.norm());
  return most;
}

/// [N] The largest change from one command to the next that is no mere shrinking: how far the new force is from the
/// nearest part of the old.
inline double largestTurn(const std::vector<Sent>& sent) {
  double most = 0;
  for (size_t i = 1; i < sent.size(); ++i) {
    const Eigen::Vector3d before = sent[i - 1].force, now = sent[i].force;
    const double part = before.squaredNorm() > 0 ? std::clamp(now.dot(before) / before.squaredNorm(), 0.0, 1.0) : 0;
    most = std::max(most, (now - part * before).norm());
  }
  return most;
}

}  // namespace hapticd::servo
