// SPDX-License-Identifier: MIT
/// Watches the servo from a thread of higher priority. If a tick does not end, or does not begin, the motors are cut
/// within 5 ms. If the servo never returns, the process is ended, and the service manager starts it again without the
/// plugin.
#pragma once
#include <atomic>
#include <functional>
#include <system_error>

#include "base/os.hpp"
#include "watch/watch_target.hpp"

namespace hapticd::watch {

class Watchdog {
 public:
  static constexpr Nanoseconds kCheckEvery = 500'000;
  static constexpr Nanoseconds kOnTime = 2'000'000;  ///< [ns] if the time between two checks is longer, a check is late
  static constexpr Nanoseconds kLateCounts = 1'000'000;  ///< [ns] time that is counted for the time before a late check
  /// [ns] longest tick of an arm. The next check follows at most 0.5 ms later; in 3 ms, 8.5 N give a free tip of 75 g
  /// an energy of 4.3 mJ.
  static constexpr Nanoseconds kStuckAfter = 2'500'000;
  /// [ns] longest tick in a virtual machine, where the processor may do other work during a tick.
  static constexpr Nanoseconds kStuckInVirtualMachine = 10'000'000;
  /// [ns] longest tick of simulated arms, unless `stuck_after` is longer. Simulated arms cannot hurt a hand, and pauses
  /// of a virtual machine count as time of the tick.
  static constexpr Nanoseconds kStuckSimulated = 60'000'000;
  /// [ns] longest delay of the next tick. In a virtual machine it is longer, because the host pauses single processors.
  static constexpr Nanoseconds kMissedAfter = 2'500'000, kMissedInVirtualMachine = 50'000'000;
  static constexpr Nanoseconds kHungAfter = 500'000'000;  ///< [ns] a tick or dry cycle that takes longer hangs
  /// [ns] a tick of a simulation that takes longer counts as hanging. In less time the servo may only have had no
  /// processor, which is not a module's fault. But a simulation that has used kHungAfter of processor time hangs.
  static constexpr Nanoseconds kHungSimulated = 5'000'000'000;
  /// [ns] longest time from the request to end until the end of the process
  static constexpr Nanoseconds kEndWithin = 900'000'000;
  static constexpr Nanoseconds kSimulatedPause = 200'000'000;  ///< [ns] a busy machine may pause a simulation this long

  /// [main] @param hung ends the process @param missed_after [ns] longest delay of the start of a tick
  /// @param stuck_after [ns] longest duration of a tick
  Watchdog(WatchTarget& servo, std::function<void()> hung, Nanoseconds missed_after = kMissedAfter,
           Nanoseconds stuck_after = kStuckAfter)
      : servo_(servo), hung_(std::move(hung)), missed_after_(missed_after), stuck_after_(stuck_after) {}
  ~Watchdog() { stop(); }

  /// [main] Sets a function that ends the process if the run was asked to end and has not ended after kEndWithin. Call
  /// it before start().
  void onLateEnd(std::function<void()> late) { late_ = std::move(late); }

  /// [main] @param priority SCHED_FIFO priority, above that of the servo. If the process has no right to this priority,
  /// the watchdog runs as an ordinary thread
  std::error_code start(int priority);
  void stop();

  /// [any] Checks the servo once, and returns true if it cut the motors. The thread of the watchdog only calls this
  /// function periodically. If a check comes late, the whole machine may have stood still before it, with this thread
  /// and the servo. So the time before a late check counts as only one millisecond, and the servo gets a moment to end
  /// its tick. If all checks come late, the motors of a stuck servo are cut by the third check at the latest; if checks
  /// are on time, within 3 ms.
  bool check(Nanoseconds now) noexcept;

  uint64_t cuts() const noexcept { return cuts_.load(); }

 private:
  /// What the servo is doing: a tick, or waiting for a tick.
  struct Phase {
    uint64_t tick = UINT64_MAX;
    bool waits = false;
    bool operator==(const Phase&) const = default;
  };
  bool checkPhase(Phase phase, Nanoseconds overdue, Nanoseconds seen) noexcept;
  void watchEnd() noexcept;
  Nanoseconds patience(Phase phase) const noexcept;
  void watchHung(Phase phase) noexcept;
  void watchResting() noexcept;
  bool mayBePaused(Phase phase, Nanoseconds stuck) const noexcept;

  WatchTarget& servo_;
  std::function<void()> hung_, late_;
  Nanoseconds missed_after_, stuck_after_;

  Phase cut_in_;  ///< the phase in which the motors were last cut; they are cut only once in each phase
  Phase phase_;
  Nanoseconds checks_since_cut_ = 0, checks_since_stop_ = 0, checks_since_beat_ = 0;
  uint64_t beats_ = 0;
  bool hung_told_ = false;
  Nanoseconds cpu_at_phase_ = 0;
  Nanoseconds looked_at_ = 0;  ///< time of the last check
  Nanoseconds counted_ = 0;    ///< [ns] duration of the phase, as far as it was watched
  std::atomic<uint64_t> cuts_{0};
  std::atomic<bool> stop_{false};
  os::Thread thread_;
};

}  // namespace hapticd::watch
