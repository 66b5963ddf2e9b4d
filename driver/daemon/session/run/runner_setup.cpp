// SPDX-License-Identifier: MIT
/// What a run needs before its first tick: models, arms, black box, clock and loop.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/os.hpp"
#include "servo/loop/paced_clock.hpp"
#include "session/messages/setup_watch.hpp"
#include "session/replay/about.hpp"
#include "session/replay/recorded_clock.hpp"
#include "session/run/runner.hpp"
#include "world/arm_force.hpp"

namespace hapticd::servo {

namespace {

Nanoseconds spinFor(const scene::Servo& servo) {
  // Spinning reduces lateness on bare metal. In a virtual machine it does not help: the pauses come from the host.
  constexpr double kBareMetalSpinUs = 50;
  const double us = servo.spin_us.value_or(os::inVirtualMachine() ? 0 : kBareMetalSpinUs);
  return static_cast<Nanoseconds>(us * 1e3);
}

/// Returns how the loop runs. @param simulated true if all arms are simulated
LoopSettings loopSettings(const scene::Scene& scene, const RunOptions& options, bool simulated) {
  LoopSettings settings;
  settings.period_ns = static_cast<Nanoseconds>(std::llround(1e9 / options.rate));
  settings.ticks = options.duration ? static_cast<uint64_t>(std::llround(*options.duration * options.rate)) : 0;
  settings.lockstep = options.virtual_time;
  if (!options.virtual_time)  // programs' answers are only awaited for a time that does not make the tick late
    settings.answer_time = std::min(static_cast<Nanoseconds>(scene.clients.answer_time * 1e9), settings.period_ns / 4);
  // A simulation at a terminal starts without dry cycles: there is no hand, and no service manager waits for READY.
  const bool watched = std::getenv("NOTIFY_SOCKET") != nullptr;
  settings.dry_cycles = !options.virtual_time && (watched || !simulated) ? kDryCycles : 0;
  return settings;
}

/// Returns the error of a device that could not be opened, with a note where virtual time is in the way of it.
Error notOpened(const Result<void>& opened, const scene::Scene& scene, bool virtual_time) {
  const bool real = std::any_of(scene.devices.begin(), scene.devices.end(),
                                [](const scene::Device& device) { return device.module != "simulated"; });
  const bool absent = opened.kind() == ErrorKind::kAbsent;  // otherwise its module is wrong
  if (!virtual_time || !real || !absent) return Error{opened.error(), opened.kind()};
  return Error{opened.error() + "\n  note: --virtual-time allows simulated devices only"};
}

}  // namespace

Result<std::unique_ptr<World>> Runner::buildWorld(const scene::Scene& scene, const RunOptions& options,
                                                  const host::Services::Log& log) {
  WorldOptions world_options;
  world_options.rate = options.rate;
  world_options.probe_count = static_cast<uint32_t>(scene.devices.size());
  world_options.measure = true;
  world_options.keep_disabled = true;
  world_options.gaps_jump = true;
  world_options.spare_models = options.spare_models;
  world_options.max_force = maxForceOf(scene);
  world_options.budgets = !options.virtual_time;  // a budget of real time would make two virtual runs differ
  const SetupWatch waiting(log);
  return World::build(scene, world_options, log);
}

Result<std::unique_ptr<Runner>> Runner::prepare(const scene::Scene& scene, const RunOptions& options,
                                                std::unique_ptr<World> world, const host::Services::Log& log) {
  std::unique_ptr<Runner> runner(new Runner(scene, options));
  runner->world_ = std::move(world);
  if (auto opened = runner->openArms(log); !opened) return notOpened(opened, scene, options.virtual_time);
  if (options.virtual_time && !onlySimulated(runner->arms_))
    return Error{
        "--virtual-time runs faster than a real clock, but the scene names real hardware; "
        "expected simulated devices only"};
  runner->telemetry_ = std::make_unique<Telemetry>(runner->scene_, options.rate, runner->world_->places());
  runner->openEventLog();
  LoopSettings settings = loopSettings(scene, options, onlySimulated(runner->arms_));
  if (auto opened = runner->openBlackBox(settings); !opened) return Error{opened.error()};
  runner->openClock(settings);
  runner->loop_ = std::make_unique<Loop>(runner->world_->core(), runner->world_->lockstep(), runner->arms_,
                                         *runner->clock_, settings, *runner->telemetry_);
  return runner;
}

/// Makes the clock of the loop. An arm that drives the loop is noted in `settings`.
void Runner::openClock(LoopSettings& settings) {
  if (options_.virtual_time && recorder_) {
    clock_ = std::make_unique<RecordedClock>(*recorder_);
  } else if (options_.virtual_time) {
    clock_ = std::make_unique<VirtualClock>();
  } else {
    clock_ = std::make_unique<RealClock>(spinFor(scene_.servo));
  }
  Arm* const pacing = pacingArm(scene_.servo, arms_);
  if (pacing == nullptr) return;
  settings.paced = true;
  clock_ = std::make_unique<PacedClock>(std::move(clock_), pacing->device(), settings.period_ns);
}

Result<void> Runner::openBlackBox(const LoopSettings& settings) {
  const auto models = world_->core().models();
  const auto moving = std::count_if(models.begin(), models.end(), [](const ModelState& m) { return m.moves; });
  const auto streams =
      flightStreams(scene_, arms_, options_.rate, Telemetry::kBlackBoxSeconds, static_cast<size_t>(moving));
  const RunFacts facts{options_.rate, settings.period_ns, settings.ticks, options_.virtual_time};
  auto ring = record::FlightRing::create(streams, aboutRun(scene_, *world_, arms_, facts, streams), options_.black_box);
  if (!ring) return Error{ring.error()};
  telemetry_->attach(std::make_unique<Flight>(std::move(*ring), arms_, world_->places()));
  if (!options_.status.empty()) {
    auto page = status::PageFile::create(options_.status);
    if (!page) return Error{page.error()};
    telemetry_->attach(std::make_unique<StatusWriter>(std::move(*page), scene_, arms_, options_.rate));
  }
  if (options_.record.empty()) return {};
  auto recorder = record::Recorder::create(telemetry_->flight()->ring(), options_.record);
  if (!recorder) return Error{recorder.error()};
  recorder_ = std::move(*recorder);
  return {};
}

Result<void> Runner::openArms(const host::Services::Log& log) {
  for (const scene::Device& device : scene_.devices) {
    auto arm = Arm::open(device, scene_.servo, {options_.rate, world_->needsVelocity(), nullptr, scene_.clients}, log);
    if (!arm) return Error{arm.error(), arm.kind()};
    arms_.push_back(std::move(*arm));
  }
  return {};
}

void Runner::openEventLog() {
  std::vector<EventLog::Named> devices;
  for (const scene::Device& device : scene_.devices) devices.push_back({device.name, device.file.string()});
  event_log_ = std::make_unique<EventLog>(world_->places(), std::move(devices), arms_);
  for (uint32_t place = 0; place < scene_.models.size(); ++place)
    event_log_->names().came(place, 0, {scene_.models[place].name, scene_.models[place].library.string()});
}

}  // namespace hapticd::servo
