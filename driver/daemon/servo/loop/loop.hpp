// SPDX-License-Identifier: MIT
/// The servo loop: waits for a deadline, reads the arms, runs the core, writes the arms, and logs the tick. The clock
/// is an argument, so the same loop runs in real time and in virtual time.
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
  uint64_t ticks = 0;           ///< length of the run in periods; 0: until stop()
  bool lockstep = false;        ///< true: the servo thread itself runs proximity searches (virtual time)
  bool paced = false;           ///< true: a tick begins when a sample of an arm comes, not at the deadline
  Nanoseconds answer_time = 0;  ///< the servo waits for the answers of pushing programs until this time in a tick
  uint64_t dry_cycles = 0;      ///< cycles with motors off before the first tick, to count those that begin late
};

/// [main] Returns the arm whose samples drive the loop: the first arm that can do so, if the scene asks for it. Returns
/// nullptr if the clock drives the loop.
Arm* pacingArm(const scene::Servo& servo, const Arms& arms);

/// [main] Returns which results of a tick these arms use.
RequiredResults usesOf(const Arms& arms);

class Loop {
 public:
  /// [main] Everything given by reference must outlive the loop.
  /// @param lockstep runs the proximity search if the settings ask for it
  Loop(Core& core, Lockstep lockstep, Arms& arms, Clock& clock, const LoopSettings& settings, TickLog& log);

  /// [main] Called before run(). @param count the loop increments it in each dry cycle and each tick, so that a
  /// watchdog sees that the servo runs; it must outlive the run
  void beatOn(std::atomic<uint64_t>& count) { beats_ = &count; }

  /// [rt] Runs until all ticks are done, or until a stop has ramped the forces down. Call it once.
  void run() noexcept;

  /// [any] Queues an order. Orders are obeyed in turn, at the start of a tick. Only one thread may call this. Returns
  /// false if the queue is full; the order is then lost.
  bool post(const Order& order) noexcept { return orders_.push(order); }
  /// [any] Returns how many orders were obeyed or refused so far.
  uint64_t ordersDone() const noexcept { return orders_done_.load(std::memory_order_acquire); }

  /// [any] Begins to ramp the forces of these arms to zero in the next tick, and keeps them off until the arms are
  /// cleared. A hold does not wait behind other orders, and any number of threads may call this. Async-signal-safe.
  /// @param arms bit i stands for arm i
  void hold(uint64_t arms) noexcept { hold_.fetch_or(arms, std::memory_order_relaxed); }
  /// [any] True if every hold of these arms has been obeyed.
  bool holdsObeyed(uint64_t arms) const noexcept { return (hold_.load(std::memory_order_acquire) & arms) == 0; }
  /// [any] True if the forces of every arm were zero at the end of the last tick, after a fault or a hold.
  bool silent() const noexcept { return silent_.load(std::memory_order_acquire); }

  /// [any] Asks the loop to end. Forces ramp to zero first. Async-signal-safe.
  void stop() noexcept {
    Nanoseconds never = 0;
    stop_asked_.compare_exchange_strong(never, monotonicNow(), std::memory_order_relaxed);
    stop_.store(true, std::memory_order_relaxed);
  }
  /// [any] True once the forces ramp to zero because the run ends.
  bool ends() const noexcept { return ends_.load(std::memory_order_relaxed); }
  /// [any] Returns the CLOCK_MONOTONIC time of the first stop(), or 0 if there was none.
  Nanoseconds stopAsked() const noexcept { return stop_asked_.load(std::memory_order_relaxed); }

  /// [any] Returns the interface through which other programs see the arms, in addition to rows.
  Door& door() noexcept { return door_; }

  /// [any] Returns how many dry cycles began at least one period late. Final once the first tick has begun.
  uint64_t lateDryCycles() const noexcept { return late_dry_cycles_.load(std::memory_order_relaxed); }

  /// [any] Returns the number of ticks done so far, for watchdogs and status lines.
  uint64_t ticks() const noexcept { return tick_count_.load(std::memory_order_relaxed); }
  /// [any] Returns the number of dry cycles and ticks done so far.
  uint64_t beats() const noexcept { return beats_->load(std::memory_order_relaxed); }
  /// [any] True if the core lost a track or saw a jump, so that a proximity search is needed now.
  bool needsSearch() const noexcept { return needs_search_.load(std::memory_order_relaxed); }
  /// [any] Returns the CLOCK_MONOTONIC time at which the tick in progress began, or 0 between two ticks.
  Nanoseconds tickBegun() const noexcept { return tick_begun_.load(std::memory_order_relaxed); }
  /// [any] Returns the CLOCK_MONOTONIC time by which the next tick must have begun, or 0 if there will be none.
  Nanoseconds nextTick() const noexcept { return next_tick_.load(std::memory_order_relaxed); }
  /// [any] Returns the CPU time that the thread of run() has used; async-signal-safe.
  Nanoseconds cpuTime() const noexcept { return os::cpuTime(cpu_clock_.load(std::memory_order_relaxed)); }
  /// [any] Returns the CLOCK_MONOTONIC time of the first tick, or 0 before it.
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
  void applyOrders(double t) noexcept HSP_RT;
  void applyOrder(const Order& order, Arm& arm) noexcept HSP_RT;
  void applyHolds() noexcept HSP_RT;
  void logTimedDecisions() noexcept HSP_RT;
  void shedLoad() noexcept HSP_RT;
  void search(double t) noexcept;
  void trip(Fault fault, double measured = 0) noexcept HSP_RT;
  void rampOut() noexcept HSP_RT;
  bool allSilent() const noexcept HSP_RT;
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
  std::atomic<uint64_t> own_beats_{0};
  std::atomic<uint64_t>* beats_ = &own_beats_;
  double epoch_ = 0;  ///< [s] time of the first tick; CLOCK_MONOTONIC if the run uses the real clock
  // In virtual time the proximity search runs in this thread too. The time of the search does not count as compute.
  Nanoseconds search_time_ = 0;
  Nanoseconds read_time_ = 0;    ///< time in this tick for reading the arms
  Nanoseconds listen_time_ = 0;  ///< time in this tick for waiting for programs' answers
  uint64_t search_allocations_ = 0, allocations_warm_ = 0;
  long faults_warm_ = 0;
  SpscRing<Order> orders_{256};
  std::atomic<uint64_t> orders_done_{0};
  std::atomic<uint64_t> hold_{0};
  std::atomic<bool> stop_{false}, needs_search_{true}, finished_{false}, silent_{false}, ends_{false};
  std::atomic<uint64_t> tick_count_{0}, late_dry_cycles_{0};
  std::atomic<Nanoseconds> first_tick_{0}, tick_begun_{0}, next_tick_{0}, stop_asked_{0};
  std::atomic<os::CpuClock> cpu_clock_{os::kNoCpuClock};
};

}  // namespace hapticd::servo
