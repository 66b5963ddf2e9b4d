// SPDX-License-Identifier: MIT
#include "servo/loop/loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/allocation_count.hpp"
#include "base/allocation_owner.hpp"
#include "base/not_real_time.hpp"
#include "base/thread_usage.hpp"

namespace hapticd::servo {

namespace {

constexpr uint64_t kWarmUpTicks = 200;  ///< page faults and allocations are counted only after these ticks

bool isToArm(const Order& order) noexcept HSP_RT {
  switch (order.kind) {
    case Order::Kind::kClear:
    case Order::Kind::kHold:
    case Order::Kind::kCut:
      return true;
    case Order::Kind::kLead:
    case Order::Kind::kUnlead:
      return order.param != static_cast<uint32_t>(Order::Led::kModel);
    default:
      return false;
  }
}

}  // namespace

Arm* pacingArm(const scene::Servo& servo, const Arms& arms) {
  if (servo.pace != scene::Pace::kDevice) return nullptr;
  const auto found = std::find_if(arms.begin(), arms.end(), [](const auto& arm) { return arm->device().canPace(); });
  return found != arms.end() ? found->get() : nullptr;
}

RequiredResults usesOf(const Arms& arms) {
  RequiredResults uses{false, false, {}, {}};
  for (const auto& arm : arms) {
    uses.torque |= arm->turns();
    uses.exchange |= arm->passivity() != nullptr;
    uses.max_force.push_back(arm->limiter().maxForce());
    uses.max_torque.push_back(arm->limiter().maxTorque());
  }
  return uses;
}

Loop::Loop(Core& core, Lockstep lockstep, Arms& arms, Clock& clock, const LoopSettings& settings, TickLog& log)
    : core_(core),
      arms_(arms),
      clock_(clock),
      settings_(settings),
      log_(log),
      lockstep_(std::move(lockstep)),
      probes_(arms.size()) {
  core_.serve(usesOf(arms_));
  double ramp = 0;
  for (const auto& arm : arms_) ramp = std::max(ramp, arm->rampOut());
  ramp_ticks_ = static_cast<uint64_t>(std::ceil(ramp * 1e9 / static_cast<double>(settings_.period_ns))) + 1;
}

void Loop::beat() noexcept HSP_RT {
  beats_->store(beats_->load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

/// Runs the dry cycles. No result is kept, so the ticks are the same with and without them.
void Loop::runDry() noexcept HSP_RT {
  Nanoseconds deadline = clock_.now();
  for (uint64_t n = 0; n < settings_.dry_cycles && !stop_; ++n) {
    const Nanoseconds woke = clock_.waitUntil(deadline);
    for (const auto& arm : arms_) arm->exchangeDry(woke);
    beat();
    if (woke >= deadline + settings_.period_ns) {
      late_dry_cycles_.store(late_dry_cycles_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      deadline = woke;
    }
    deadline = (settings_.paced ? woke : deadline) + settings_.period_ns;
  }
}

void Loop::run() noexcept {
  runDry();
  Nanoseconds start = clock_.now(), deadline = start, last = start;
  first_tick_ = monotonicNow();
  cpu_clock_ = os::cpuClockOfThread();
  countFromHere();
  for (uint64_t n = 0, done = 0;; ++n) {
    if (stop_ || (settings_.ticks != 0 && done + ramp_ticks_ >= settings_.ticks)) rampOut();
    const Nanoseconds woke = clock_.waitUntil(deadline);
    const Nanoseconds due = std::min(deadline, woke);
    deadline = timeOfTick(deadline, woke);
    if (n == 0) {
      start = last = deadline;
      epoch_ = static_cast<double>(start) * kSecondsPerNanosecond;
      core_.startAt(epoch_);
    }
    const Nanoseconds begun = monotonicNow();
    tick_begun_.store(begun, std::memory_order_relaxed);
    search_time_ = listen_time_ = 0;
    const double dt = static_cast<double>(deadline - last) * kSecondsPerNanosecond;
    if (dt > Core::kLongestGap && !onlySimulated(arms_)) trip(Fault::kLate, dt);  // the last force stayed on meanwhile
    const double t = static_cast<double>(deadline - start) * kSecondsPerNanosecond;
    log_.begin(deadline, arms_);
    tick({n, deadline, t, dt});
    const Nanoseconds ended = monotonicNow();
    log_.tick(t, dt, woke - due, {ended - begun - search_time_ - listen_time_, read_time_}, core_, arms_);
    last = deadline;
    deadline += settings_.period_ns;
    publishTick(n, ended);
    if (n == kWarmUpTicks) countFromHere();
    done = (last - start) / settings_.period_ns + 1;
    if ((settings_.ticks != 0 && done >= settings_.ticks) || (stop_ && allSilent())) break;
  }
  noteAllocations(false);
  next_tick_.store(0, std::memory_order_relaxed);
  log_.finish(tick_count_, clock_.now() - start, os::pageFaultsOfThread() - faults_warm_,
              allocationsOfThread() - allocations_warm_ - search_allocations_);
  finished_.store(true, std::memory_order_release);
}

/// Shows other threads and processes that a tick has ended. Called once its row is written.
void Loop::publishTick(uint64_t number, Nanoseconds ended) noexcept HSP_RT {
  door_.written(number);
  tick_count_.store(number + 1, std::memory_order_relaxed);
  beat();
  silent_.store(allSilent(), std::memory_order_release);
  next_tick_.store(ended + longestRest(), std::memory_order_relaxed);
  tick_begun_.store(0, std::memory_order_relaxed);
}

/// Starts to count page faults and allocations, after the warm-up.
void Loop::countFromHere() noexcept {
  search_allocations_ = 0;
  faults_warm_ = os::pageFaultsOfThread();
  allocations_warm_ = allocationsOfThread();
  noteAllocations(true);
}

/// Returns the longest time between two ticks that is normal: longer if samples drive the loop, see PacedClock.
Nanoseconds Loop::longestRest() const noexcept HSP_RT {
  return settings_.paced ? 5 * settings_.period_ns / 2 : settings_.period_ns;
}

void Loop::trip(Fault fault, double measured) noexcept HSP_RT {
  for (const auto& arm : arms_) arm->limiter().trip(fault, measured);
}

/// Ramps all forces down to end the run. An earlier fault is kept, because the user must know of it.
void Loop::rampOut() noexcept HSP_RT {
  ends_.store(true, std::memory_order_relaxed);
  for (const auto& arm : arms_)
    if (arm->limiter().fault() == Fault::kNone) arm->limiter().trip(Fault::kStopped);
}

bool Loop::allSilent() const noexcept HSP_RT {
  return std::all_of(arms_.begin(), arms_.end(), [](const auto& arm) { return arm->limiter().silent(); });
}

void Loop::applyOrders(double t) noexcept HSP_RT {
  constexpr int kOrdersPerTick = 16;
  applyHolds();
  Order order;
  for (int i = 0; i < kOrdersPerTick && orders_.pop(order); ++i) {
    if (!isToArm(order)) {
      core_.apply(order, t);
    } else if (order.target < arms_.size()) {
      applyOrder(order, *arms_[order.target]);
    }
    log_.order(order);
    orders_done_.store(orders_done_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }
}

/// Turns holds into orders, so that they are recorded. Unlike other orders, they do not wait in the queue.
void Loop::applyHolds() noexcept HSP_RT {
  const uint64_t held = hold_.load(std::memory_order_relaxed);
  if (held == 0) return;
  Order order;
  order.kind = Order::Kind::kHold;
  for (uint32_t i = 0; i < arms_.size() && i < 64; ++i) {
    if (((held >> i) & 1u) == 0) continue;
    order.target = i;
    applyOrder(order, *arms_[i]);
    log_.order(order);
  }
  hold_.fetch_and(~held, std::memory_order_release);
}

void Loop::applyOrder(const Order& order, Arm& arm) noexcept HSP_RT {
  switch (order.kind) {
    case Order::Kind::kClear:
      return arm.clear();
    case Order::Kind::kHold:
      return arm.limiter().trip(Fault::kStopped);
    case Order::Kind::kLead:
      if (order.push != nullptr) return arm.clients().begin(order.place, *order.push);
      if (order.slot != nullptr) arm.hand().begin(*order.slot, arm.probe().position);
      return;
    case Order::Kind::kUnlead:
      if (order.param == static_cast<uint32_t>(Order::Led::kForce)) return arm.clients().end(order.place);
      return arm.hand().end();
    default:
      return arm.cutAsThen(order.value > 0 ? Arm::CutFound::kInRead : Arm::CutFound::kInWrite, order.seconds);
  }
}

/// After a tick: logs the decisions that depended on measured times, for replay.
void Loop::logTimedDecisions() noexcept HSP_RT {
  Order order;
  order.kind = Order::Kind::kOverran;
  for (const uint32_t index : core_.live()) {
    if (!core_.models()[index].overran) continue;
    order.target = index;
    log_.order(order);
  }
  order.kind = Order::Kind::kCut;
  for (uint32_t i = 0; i < arms_.size(); ++i) {
    const Arm::CutFound found = arms_[i]->takeCutFound();
    if (found == Arm::CutFound::kNo) continue;
    order.target = i;
    order.value = found == Arm::CutFound::kInRead ? 1 : 0;
    order.seconds = arms_[i]->cutAfter();
    log_.order(order);
  }
}

/// Sets the accuracy of the models for this tick. Changes are logged like orders, because they change forces.
void Loop::shedLoad() noexcept HSP_RT {
  for (const LoadShedding::Change& change : core_.shedLoad()) {
    Order order;
    order.kind = Order::Kind::kAccuracy;
    order.target = change.model;
    order.value = change.level;
    log_.order(order);
  }
}

void Loop::search(double t) noexcept {
  const Nanoseconds begun = monotonicNow();
  const uint64_t allocations = allocationsOfThread();
  const NotRealTime virtual_time_only;
  noteAllocations(false);  // a search may allocate
  lockstep_.before(t);
  noteAllocations(tick_count_.load(std::memory_order_relaxed) > kWarmUpTicks);
  search_allocations_ += allocationsOfThread() - allocations;
  search_time_ = monotonicNow() - begun;
}

/// Returns the time of a tick: the time of waking if samples drive the loop, otherwise the deadline.
Nanoseconds Loop::timeOfTick(Nanoseconds deadline, Nanoseconds woke) noexcept HSP_RT {
  const Nanoseconds by_clock = skipMissed(deadline, woke);
  return settings_.paced ? woke : by_clock;
}

Nanoseconds Loop::skipMissed(Nanoseconds deadline, Nanoseconds woke) noexcept HSP_RT {
  if (woke < deadline + settings_.period_ns) return deadline;
  // Skips whole periods and keeps the phase, because late ticks run back to back would make the next ones late too.
  const uint64_t missed = (woke - deadline) / settings_.period_ns;
  log_.overrun(missed);
  return deadline + missed * settings_.period_ns;
}

void Loop::tick(const TickTime& tick) noexcept HSP_RT {
  applyOrders(tick.t);
  shedLoad();
  for (const auto& arm : arms_) arm->hand().step(tick.t, tick.dt, epoch_);
  read_time_ = monotonicNow();
  for (size_t i = 0; i < arms_.size(); ++i) probes_[i] = arms_[i]->read(tick.time, tick.dt);
  read_time_ = monotonicNow() - read_time_;
  door_.publish(tick, arms_);
  core_.publish(tick.t, probes_);
  if (settings_.lockstep) search(tick.t);
  core_.tick(tick.t, tick.dt, probes_);
  if (settings_.answer_time > 0) listen(tick);
  for (uint32_t i = 0; i < arms_.size(); ++i) write(i, tick);
  logTimedDecisions();
  needs_search_.store(core_.needsSearch(), std::memory_order_relaxed);
}

/// Waits until every program that keeps up has answered, or until answer_time is over. It waits busily, because a sleep
/// would last too long.
void Loop::listen(const TickTime& tick) noexcept HSP_RT {
  const auto awaited = [&](const auto& arm) { return arm->clients().awaits(tick.number); };
  const Nanoseconds begun = monotonicNow();
  const Nanoseconds over = tick_begun_.load(std::memory_order_relaxed) + settings_.answer_time;
  Nanoseconds now = begun;
  while (now < over && std::any_of(arms_.begin(), arms_.end(), awaited)) now = monotonicNow();
  listen_time_ = now - begun;
}

/// Writes the forces to one arm. The programs' answers are collected as late as possible, so that an answer in this
/// tick still counts.
void Loop::write(uint32_t index, const TickTime& tick) noexcept HSP_RT {
  Arm& arm = *arms_[index];
  ClientForces& clients = arm.clients();
  clients.collect(tick.number, tick.dt);
  arm.carryWeight(core_.present() > 0 || clients.present());
  if (!clients.present() && clients.share() == 1)
    return arm.write(tick.time, tick.dt, core_.force(index), core_.torque(index), core_.exchange(index));
  passivity::Exchange exchange = core_.exchange(index);
  exchange.recoverable = std::numeric_limits<double>::infinity();  // the energy that a program has stored is unknown
  exchange.pushed = true;
  arm.write(tick.time, tick.dt, clients.share() * core_.force(index) + clients.force(),
            clients.share() * core_.torque(index) + clients.torque(), exchange);
}

}  // namespace hapticd::servo
