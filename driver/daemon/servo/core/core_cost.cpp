// SPDX-License-Identifier: MIT
/// The cost of answers: the accuracy of each shape, and what happens to a shape that takes too long.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/clock.hpp"
#include "base/thread_usage.hpp"
#include "servo/core/core.hpp"

namespace hapticd::servo {

/// True if a shape may skip this tick. A resting shape at the coarsest level answers only in every fourth tick if no
/// probe can reach it before; meanwhile its last foot and distance are used. Different shapes skip different ticks.
bool Core::mayRest(const ModelState& model, uint32_t index, double dt) const noexcept HSP_RT {
  if (model.always || model.moves || model.change_count > 0) return false;
  if ((tick_ + index) % Accuracy::kTurns == 0) return false;
  const double reach = settings_.max_probe_speed * dt * Accuracy::kTurns;
  for (uint32_t i = 0; i < probe_count_; ++i) {
    const Contact& last = contact(index, i);
    if (jumped_[i] != 0 || !last.traced || last.world.depth_m > -reach) return false;
  }
  return true;
}

Core::CostStart Core::beginCost() const noexcept HSP_RT {
  if (!settings_.measure) return {};
  return {monotonicNow(), cpu_timed_ ? os::cpuTimeOfThread() : 0};
}

void Core::takeCost(ModelState& model, const CostStart& begun) noexcept HSP_RT {
  // [ticks] CPU time is measured for this many ticks after a tick that was too long
  constexpr uint32_t kSuspicion = 100;
  model.step_ns = monotonicNow() - begun.wall;
  model.cpu_timed = begun.cpu != 0;
  if (settings_.evaluation_ns > 0) {
    uint64_t evaluations = 0;
    for (const hsp_contact& out : outputs_) evaluations += out.iterations;
    model.step_ns = static_cast<uint64_t>(settings_.evaluation_ns * static_cast<double>(evaluations));
  } else if (model.cpu_timed) {
    model.step_ns = std::min(model.step_ns, os::cpuTimeOfThread() - begun.cpu);
  }
  // a spent budget stays at 1 ns (0 means unlimited), so that the next shape still answers, but as fast as it can
  if (budget_left_ns_ > 0) budget_left_ns_ = budget_left_ns_ > model.step_ns ? budget_left_ns_ - model.step_ns : 1;
  if (budget_left_ns_ == 1 && settings_.evaluation_ns == 0) suspicious_ = kSuspicion;
}

/// True if the kernel interrupted the thread in this tick, so that a long step is not the shape's fault. If CPU time is
/// measured, interruptions are not in it, so they excuse nothing; otherwise a watchdog on the same processor would
/// excuse every step.
bool Core::excused() noexcept HSP_RT {
  if (settings_.evaluation_ns > 0 || cpu_timed_) return false;
  preempted_ |= os::wasPreempted();
  return preempted_;
}

std::span<const LoadShedding::Change> Core::shedLoad() noexcept HSP_RT {
  if (settings_.budget_ns == 0 || !settings_.measure) return {};
  loads_.clear();
  uint64_t spent = 0;
  for (const uint32_t index : live_) {
    const ModelState& model = models_[index];
    double importance = -HUGE_VAL;
    for (uint32_t i = 0; i < probe_count_; ++i)
      if (contact(index, i).traced) importance = std::max(importance, contact(index, i).world.depth_m);
    loads_.push_back(
        {index, model.level, model.step_ns, model.finer_ns, importance, model.cpu_timed});  // reserved: never allocates
    spent += model.step_ns;
  }
  if (spent > settings_.budget_ns && excused()) return {};
  const auto changes = shedding_.findChanges(loads_, settings_.budget_ns);
  for (const LoadShedding::Change& change : changes) setLevel(models_[change.model], change.level);
  return changes;
}

bool Core::setLevel(ModelState& model, uint32_t level) noexcept HSP_RT {
  if (level > Accuracy::kCoarsest) return false;
  if (level > model.level) model.finer_ns = model.step_ns;
  model.level = level;
  model.coarsest = std::max(model.coarsest, level);
  return true;
}

ShapeFault Core::holdToTime(ModelState& model) noexcept HSP_RT {
  constexpr int kOverruns = 4;
  if (std::exchange(model.overran_then, false)) return model.guard.strike(ShapeFault::kOverrun, kOverruns);
  const bool overran = settings_.budget_ns > 0 && settings_.measure && model.step_ns > settings_.budget_ns;
  const bool may_hasten = settings_.evaluation_ns > 0 || model.level < Accuracy::kCoarsest;
  if (!overran || may_hasten) return ShapeFault::kNone;
  if (excused()) return ShapeFault::kNone;
  model.overran = true;
  return model.guard.strike(ShapeFault::kOverrun, kOverruns);
}

}  // namespace hapticd::servo
