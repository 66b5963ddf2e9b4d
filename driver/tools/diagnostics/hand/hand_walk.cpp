// SPDX-License-Identifier: MIT
#include "diagnostics/hand/hand_walk.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <ctime>
#include <memory>

#include "base/allocation_owner.hpp"
#include "base/clock.hpp"
#include "base/thread_waits.hpp"
#include "diagnostics/hand/hand_script.hpp"
#include "diagnostics/scene/trial_end.hpp"
#include "record/allocation_text.hpp"
#include "record/contact_warnings.hpp"
#include "servo/arm/arm.hpp"
#include "servo/loop/loop.hpp"
#include "session/messages/silence_reason.hpp"
#include "session/telemetry/telemetry.hpp"

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;
using servo::Limit;

constexpr double kMostSeconds = 10;
/// [s] A short motion is repeated for so long: one press of a gentle hand shows too little of the energy that a shape
/// gives.
constexpr double kLeastSeconds = 3;
constexpr uint64_t kMostTicks = 10'000;
constexpr uint64_t kEnoughWaits = 1000;  ///< ticks with a wait, after which no more are needed

/// [s] Returns how long the hands move at least. An arm under compliance control may begin to swing after a while.
double leastSeconds(const scene::Scene& scene) {
  const bool complies = std::any_of(scene.devices.begin(), scene.devices.end(),
                                    [](const scene::Device& device) { return device.admittance.has_value(); });
  return complies ? kMostSeconds : kLeastSeconds;
}

double processorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Returns the number of the first joint that is at an end of its range, from 1, or 0.
uint32_t jointAtEnd(const hdv_info& info, const hdv_sample& sample) noexcept HSP_RT {
  servo::StopCounts once;
  once.add(info, sample);
  for (uint32_t i = 0; i < info.joint_count && i < HDV_MAX_JOINTS; ++i)
    if (once.ticks(i) > 0) return i + 1;
  return 0;
}

/// Looks at every tick, and ends the loop once everything was seen.
class WalkLog final : public servo::TickLog {
 public:
  WalkLog(const scene::Scene& scene, const servo::World& world, double once)
      : telemetry_(scene, scene.servo.rate),
        once_(once),
        least_(leastSeconds(scene)),
        begun_(processorSeconds()),
        boxes_(scene.models.size()),
        began_at_(scene.models.size()) {
    walk_.models.resize(scene.models.size());
    walk_.arms.resize(scene.devices.size());
    clips_.resize(scene.devices.size());
    waits_.resize(scene.models.size());
    for (size_t i = 0; i < boxes_.size(); ++i) {
      Eigen::AlignedBox3d box;
      if (world.shapes()[i]->bounds(box.min().data(), box.max().data())) boxes_[i] = box;
    }
  }

  void ends(servo::Loop& loop) { loop_ = &loop; }

  /// Returns the walk, with the judgement that a run gives at its end.
  Walk take(const servo::Core& core) {
    const record::RunReport report = telemetry_.report({});
    const AllocationShare most = mostAllocations();
    if (most.owner != nullptr && !most.owner->device && !record::allocationText(report, most).empty())
      walk_.allocates = most.owner->name;
    for (size_t i = 0; i < walk_.models.size(); ++i) judge(core.models()[i], report.models[i]);
    walk_.waiter = static_cast<uint32_t>(std::max_element(waits_.begin(), waits_.end()) - waits_.begin());
    return std::move(walk_);
  }

  void begin(Nanoseconds, const servo::Arms&) noexcept HSP_RT override { waited_before_ = os::waitsOfThread(); }
  void order(const servo::Order&) noexcept HSP_RT override {}
  void overrun(uint64_t) noexcept HSP_RT override {}
  void finish(uint64_t ticks, Nanoseconds elapsed, long page_faults, uint64_t allocations) noexcept override {
    telemetry_.finish(ticks, elapsed, page_faults, allocations);
  }

  void tick(double t, double dt, Nanoseconds late, const servo::TickDuration& spent, const servo::Core& core,
            const servo::Arms& arms) noexcept HSP_RT override {
    constexpr uint64_t kLookEvery = 64;  // ticks
    if (ended_) return;
    noteTick();
    observeWaits(core);
    telemetry_.tick(t, dt, late, spent, core, arms);
    for (uint32_t i = 0; i < walk_.models.size(); ++i) observeModel(i, core, arms);
    for (uint32_t i = 0; i < arms.size(); ++i) {
      observeArm(i, core, *arms[i]);
      walk_.arms[i].swing.add(t, arms[i]->probe().position);
    }
    if (ticks_++ % kLookEvery == 0) late_ = processorSeconds() - begun_ > kMostProcessor;
    walk_.ticks = ticks_;
    const bool all =
        std::all_of(walk_.arms.begin(), walk_.arms.end(), [](const WalkedArm& arm) { return arm.touched; });
    walk_.whole = t >= once_ || walk_.whole;
    walk_.late = late_ && !walk_.whole;
    walk_.waited = walk_.waits >= kEnoughWaits && !walk_.whole;
    // A model that moves by itself may still come to a hand that waits for it.
    if (!late_ && !walk_.waited && !(walk_.whole && (all || !moves_) && t >= least_)) return;
    ended_ = true;
    loop_->stop();
  }

 private:
  /// Judges a plugin as a run does. A step that took too long is left out, because that depends on the machine.
  void judge(const servo::ModelState& state, record::ModelReport report) {
    report.moves = state.moves;
    report.size_m = state.shape->report().size_m;
    const bool slow = state.guard.fault() == servo::ShapeFault::kOverrun;
    const std::string fault = slow ? "" : servo::silenceReason(state);
    walk_.silenced.push_back(state.guard.silenced());
    walk_.judged.push_back(record::contactWarnings(report));
    if (!fault.empty()) walk_.judged.back().push_back(fault);
  }

  /// Counts the tick if the thread waited in it, for the model whose steps took longest.
  void observeWaits(const servo::Core& core) noexcept HSP_RT {
    if (os::waitsOfThread() == waited_before_) return;
    ++walk_.waits;
    uint32_t longest = 0;
    for (uint32_t i = 1; i < waits_.size(); ++i)
      if (core.models()[i].step_ns > core.models()[longest].step_ns) longest = i;
    if (longest < waits_.size()) ++waits_[longest];
  }

  void observeModel(uint32_t index, const servo::Core& core, const servo::Arms& arms) noexcept HSP_RT {
    const servo::ModelState& state = core.models()[index];
    WalkedModel& seen = walk_.models[index];
    if (ticks_ == 0) began_at_[index] = state.frame.origin_world;
    moves_ = moves_ || state.moves;
    seen.seconds += static_cast<double>(state.step_ns) * 1e-9;
    seen.travel = std::max(seen.travel, (state.frame.origin_world - began_at_[index]).norm());
    bool inside = false;
    for (uint32_t probe = 0; probe < arms.size(); ++probe) {
      const servo::Contact& contact = core.contact(index, probe);
      const Vector3d& tip = arms[probe]->probe().position;
      WalkedArm& arm = walk_.arms[probe];
      double away = HUGE_VAL;
      if (contact.traced)
        away = -contact.world.depth_m;
      else if (const auto& box = boxes_[index])
        away = box->exteriorDistance(state.frame.pointToModel(tip));
      if (away < arm.away) {
        arm.away = away, arm.nearest = index;
        arm.end = jointAtEnd(arms[probe]->info(), arms[probe]->sample());
      }
      const double force = Vector3d(contact.world.force).norm();
      seen.clicked = seen.clicked || (contact.world.flags & HSP_OUT_EVENT) != 0;
      if (force > seen.force) {
        seen.force = force;
        seen.push = -state.frame.vectorToModel(Vector3d(contact.world.force)) / force;
      }
      arm.touched = arm.touched || force > 0 || (contact.traced && contact.world.depth_m > 0);
      if (!contact.traced || !(contact.world.depth_m > 0)) continue;
      inside = true;
      arm.began_inside = arm.began_inside || ticks_ == 0;
      seen.depth = std::max(seen.depth, contact.world.depth_m);
      if (contact.world.depth_m > arm.depth) arm.depth = contact.world.depth_m, arm.deepest = index;
    }
    seen.touched += inside;
  }

  void observeArm(uint32_t index, const servo::Core& core, const servo::Arm& arm) noexcept HSP_RT {
    WalkedArm& seen = walk_.arms[index];
    seen.stops.add(arm.info(), arm.sample());
    const servo::Clips& clips = arm.limiter().clips();
    const double asked = core.force(index).norm();
    seen.asked = std::max(seen.asked, asked);
    bool cut = false;
    for (size_t limit = 0; limit < servo::kLimitCount; ++limit) {
      const bool now = clips.ticks[limit] > clips_[index].ticks[limit];
      // Limits for the arm's own weight and for old samples do not depend on the scene.
      if (!now || limit == static_cast<size_t>(Limit::kWeight) || limit == static_cast<size_t>(Limit::kSample))
        continue;
      cut = true;
      if (asked > 0 && arm.limiter().allowed() >= 1) ++seen.limits[limit];
    }
    clips_[index] = clips;
    if (!(asked > 0) || arm.limiter().allowed() < 1) return;  // still ramping in
    ++seen.contact;
    seen.cut += cut;
  }

  servo::Telemetry telemetry_;
  double once_, least_, begun_;
  std::vector<std::optional<Eigen::AlignedBox3d>> boxes_;
  std::vector<Vector3d> began_at_;
  std::vector<servo::Clips> clips_;
  std::vector<uint64_t> waits_;  ///< for each model: ticks with a wait in which its steps took longest
  long waited_before_ = 0;
  servo::Loop* loop_ = nullptr;
  uint64_t ticks_ = 0;
  bool moves_ = false, ended_ = false, late_ = false;
  Walk walk_;
};

}  // namespace

std::optional<Walk> walkHands(const scene::Scene& scene, servo::World& world) {
  double once = 0;
  servo::Arms arms;
  for (const scene::Device& device : scene.devices) {
    const auto hand = handScriptOf(device);
    auto arm = hand ? servo::Arm::open(device, scene.servo,
                                       {scene.servo.rate, world.needsVelocity(), nullptr, scene.clients}, nullptr)
                    : Result<std::unique_ptr<servo::Arm>>(Error{"not simulated"});
    if (!hand || !arm || !(*arm)->start(0, scene.servo.gravity)) return std::nullopt;  // refusedArms() reports why
    arms.push_back(std::move(*arm));
    once = std::max(once, hand->cycleTime());
  }
  servo::LoopSettings settings;
  settings.period_ns = static_cast<Nanoseconds>(std::llround(1e9 / scene.servo.rate));
  settings.ticks = std::min(kMostTicks, static_cast<uint64_t>(kMostSeconds * scene.servo.rate));
  settings.lockstep = true;
  VirtualClock clock;
  WalkLog log(scene, world, once);
  servo::Loop loop(world.core(), world.lockstep(), arms, clock, settings, log);
  log.ends(loop);
  loop.run();
  Walk walk = log.take(world.core());
  walk.period = 1 / scene.servo.rate;
  for (size_t i = 0; i < arms.size(); ++i) {
    walk.limiters.push_back(arms[i]->limiter());
    walk.arms[i].rate = arms[i]->info().rate_hz;
    arms[i]->stop();
  }
  return walk;
}

}  // namespace hapticd::diagnostics
