// SPDX-License-Identifier: MIT
/// The servo loop: waits for a deadline, reads the arms, runs the core, writes the arms, keeps the books. The clock is
/// an argument: the same loop runs under SCHED_FIFO and in virtual time.
#pragma once
#include <atomic>
#include <memory>
#include <vector>

#include "base/clock.hpp"
#include "base/thread_usage.hpp"
#include "servo/arm/arm.hpp"
#include "servo/loop/door.hpp"
#include "servo/loop/lockstep.hpp"
#include "servo/loop/tick_log.hpp"

namespace hapticd::servo {

struct LoopSettings {
  Nanoseconds period_ns = 1'000'000;
  uint64_t ticks = 0;     ///< length of the run in periods; 0: until it is stopped
  bool lockstep = false;  ///< searches in step with the ticks (virtual time) instead of in a thread of its own
  bool paced = false;     ///< the clock follows an arm's samples: a tick is when the sample comes, not at the deadline
  Nanoseconds answer_time = 0;  ///< time after a tick began in which the servo listens to pushing programs
  uint64_t dry_cycles = 0;      ///< cycles with motors off before the first tick, which show how the machine keeps time
};

/// [main] The arm whose samples drive the loop: the first that can, if the scene asks for one. nullptr: the clock does.
Arm* pacingArm(const scene::Servo& servo, const Arms& arms);

/// [main] What these arms do with a tick's answers.
Uses usesOf(const Arms& arms);

class Loop {
 public:
  /// [main] Everything that is given by reference must outlive the loop.
  /// @param lockstep runs the simulation side where the settings ask for it
  Loop(Core& core, Lockstep lockstep, Arms& arms, Clock& clock, const LoopSettings& settings, TickLog& log);

  /// [main] Called before run(): counts dry cycles and ticks for those who watch from outside. It outlives the run.
  void beatOn(std::atomic<uint64_t>& count) { beat_ = &count; }

  /// [rt] Runs until the ticks are done or a stop has ramped the forces down. Call it once.
  void run() noexcept;

  /// [any] Queues an order of a person. Orders are obeyed in turn, at the start of a tick. Only one thread may call
  /// this. False if the queue is full, so that the order is lost.
  bool give(const Order& order) noexcept { return orders_.push(order); }
  /// [any] How many orders were obeyed or refused so far.
  uint64_t ordersDone() const noexcept { return orders_done_.load(std::memory_order_acquire); }

  /// [any] Ramps the forces of these arms to zero in the next tick, and keeps them off until they are cleared. It does
  /// not wait behind other orders, and any number of threads may call it. Async-signal-safe. @param arms bit i: arm i
  void hold(uint64_t arms) noexcept { hold_.fetch_or(arms, std::memory_order_relaxed); }
  /// [any] True if no hold of these arms is still to be obeyed.
  bool holdsObeyed(uint64_t arms) const noexcept { return (hold_.load(std::memory_order_acquire) & arms) == 0; }
  /// [any] True if every arm had ramped down, by a fault or a hold, when the last tick ended.
  bool silent() const noexcept { return silent_.load(std::memory_order_acquire); }

  /// [any] Asks for an end: forces ramp to zero first. Async-signal-safe.
  void stop() noexcept {
    Nanoseconds never = 0;
    stop_asked_.compare_exchange_strong(never, monotonicNow(), std::memory_order_relaxed);
    stop_.store(true, std::memory_order_relaxed);
  }
  /// [any] CLOCK_MONOTONIC when an end was first asked for; 0: never.
  Nanoseconds stopAsked() const noexcept { return stop_asked_.load(std::memory_order_relaxed); }

  /// [any] What outside programs are told in addition to the rows.
  Door& door() noexcept { return door_; }

  /// [any] Dry cycles that began a period late or more; final once there were ticks.
  uint64_t lateDryCycles() const noexcept { return late_dry_cycles_.load(std::memory_order_relaxed); }

  /// [any] Ticks done so far, for watchdogs and status lines.
  uint64_t ticks() const noexcept { return tick_count_.load(std::memory_order_relaxed); }
  /// [any] True if the core lost a track or saw a jump, so that a search is needed now.
  bool wantsSearch() const noexcept { return wants_search_.load(std::memory_order_relaxed); }
  /// [any] CLOCK_MONOTONIC of the tick in progress; 0: it waits for one.
  Nanoseconds tickBegun() const noexcept { return tick_begun_.load(std::memory_order_relaxed); }
  /// [any] CLOCK_MONOTONIC by which the next tick must have begun; 0: none is to come.
  Nanoseconds nextTick() const noexcept { return next_tick_.load(std::memory_order_relaxed); }
  /// [any] CPU time that the thread of run() has used; async-signal-safe.
  Nanoseconds cpuTime() const noexcept { return os::cpuTime(cpu_clock_.load(std::memory_order_relaxed)); }
  /// [any] CLOCK_MONOTONIC of the first tick, once there was one.
  Nanoseconds firstTick() const noexcept { return first_tick_.load(std::memory_order_relaxed); }
  bool finished() const noexcept { return finished_.load(std::memory_order_acquire); }

 private:
  void tick(const TickTime& tick) noexcept HSP_RT;
  void listen(const TickTime& tick) noexcept HSP_RT;
  void write(uint32_t index, const TickTime& tick) noexcept HSP_RT;
  void runDry() noexcept HSP_RT;
  void publishTick(uint64_t number, Nanoseconds ended) noexcept HSP_RT;
  void countFromHere() noexcept;
  void beat() noexcept HSP_RT;
  void obey(double t) noexcept HSP_RT;
  void obey(const Order& order, Arm& arm) noexcept HSP_RT;
  void obeyHolds() noexcept HSP_RT;
  void logTimedDecisions() noexcept HSP_RT;
  void shedLoad() noexcept HSP_RT;
  void search(double t) noexcept;
  void trip(Fault fault, double measured = 0) noexcept HSP_RT;
  void rampOut() noexcept HSP_RT;
  bool allSilent() const noexcept HSP_RT;
  bool simulated() const noexcept HSP_RT;
  Nanoseconds longestRest() const noexcept HSP_RT;
  Nanoseconds timeOfTick(Nanoseconds deadline, Nanoseconds woke) noexcept HSP_RT;
  Nanoseconds skipMissed(Nanoseconds deadline, Nanoseconds woke) noexcept HSP_RT;

  Core& core_;
  Arms& arms_;
  Clock& clock_;
  LoopSettings settings_;
  TickLog& log_;
  Lockstep lockstep_;
  Door door_;
  std::vector<Probe> probes_;
  uint64_t ramp_ticks_ = 0;
  std::atomic<uint64_t>* beat_ = nullptr;
  double epoch_ = 0;  ///< [s] CLOCK_MONOTONIC of the first tick, in a run on the real clock
  // In virtual time the simulation side works in this thread too, and its time does not count as the servo's.
  Nanoseconds search_time_ = 0;
  Nanoseconds read_time_ = 0;    ///< of this tick
  Nanoseconds listen_time_ = 0;  ///< the part of this tick spent on programs that had not answered yet
  uint64_t search_allocations_ = 0, allocations_warm_ = 0;
  long faults_warm_ = 0;
  SpscRing<Order> orders_{256};
  std::atomic<uint64_t> orders_done_{0};
  std::atomic<uint64_t> hold_{0};
  std::atomic<bool> stop_{false}, wants_search_{true}, finished_{false}, silent_{false};
  std::atomic<uint64_t> tick_count_{0}, late_dry_cycles_{0};
  std::atomic<Nanoseconds> first_tick_{0}, tick_begun_{0}, next_tick_{0}, stop_asked_{0};
  std::atomic<os::CpuClock> cpu_clock_{os::kNoCpuClock};
};

}  // namespace hapticd::servo
