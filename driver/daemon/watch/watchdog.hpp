// SPDX-License-Identifier: MIT
/// Watches the servo from a thread above it: a tick that does not end, or does not begin, has its motors cut within
/// 5 ms, and a servo that never comes back ends the process, so that the service manager starts it anew without the
/// plugin.
#pragma once
#include <atomic>
#include <functional>
#include <system_error>

#include "base/os.hpp"
#include "watch/watched.hpp"

namespace hapticd::watch {

class Watchdog {
 public:
  static constexpr Nanoseconds kCheckEvery = 500'000;
  static constexpr Nanoseconds kOnTime = 2'000'000;      ///< a longer time between two looks: it was delayed itself
  static constexpr Nanoseconds kLateCounts = 1'000'000;  ///< of such a way
  /// With the time to the next look 3 ms, in which 8.5 N give a free tip of 75 g an energy of 4.3 mJ.
  static constexpr Nanoseconds kStuckAfter = 2'500'000;
  /// A virtual machine charges a thread for time in which its processor was elsewhere.
  static constexpr Nanoseconds kStuckInVirtualMachine = 10'000'000;
  /// At least: a simulated arm hurts no hand, and a virtual machine that stands still charges the servo for it.
  static constexpr Nanoseconds kStuckSimulated = 60'000'000;
  /// The next tick is so late. A virtual machine has its processors paused one by one.
  static constexpr Nanoseconds kMissedAfter = 2'500'000, kMissedInVirtualMachine = 50'000'000;
  static constexpr Nanoseconds kHungAfter = 500'000'000;  ///< nothing returns after that
  /// Nor does a simulation return. Before that it may be a servo without a processor, which is no module's fault; then
  /// only one that has used kHungAfter of processor time hangs.
  static constexpr Nanoseconds kHungSimulated = 5'000'000'000;
  static constexpr Nanoseconds kEndWithin = 900'000'000;       ///< counted from the moment that the end was asked for
  static constexpr Nanoseconds kSimulatedPause = 200'000'000;  ///< a busy machine may pause a simulation for so long

  /// [main] @param hung what ends the process  @param missed_after [ns] that a tick may begin late
  /// @param stuck_after [ns] that it may take
  Watchdog(Watched& servo, std::function<void()> hung, Nanoseconds missed_after = kMissedAfter,
           Nanoseconds stuck_after = kStuckAfter)
      : servo_(servo), hung_(std::move(hung)), missed_after_(missed_after), stuck_after_(stuck_after) {}
  ~Watchdog() { stop(); }

  /// [main] Before start(): what ends the process if its end was asked for and does not come.
  void onLateEnd(std::function<void()> late) { late_ = std::move(late); }

  /// [main] @param priority SCHED_FIFO, above the servo's; without the right it runs as an ordinary thread
  std::error_code start(int priority);
  void stop();

  /// [any] One look; the thread does nothing else. True: it cut. A look that comes late saw nothing of the time before
  /// it: the whole machine may have stood still, this thread and the servo alike. Such a time counts as one
  /// millisecond, so that the servo gets a moment to end its tick; a servo that is stuck is then cut by the third look
  /// at the latest if all come late, and within 3 ms once the looks are on time.
  bool check(Nanoseconds now) noexcept;

  uint64_t cuts() const noexcept { return cuts_.load(); }

 private:
  /// What the servo is doing: a tick, or the wait for one.
  struct Phase {
    uint64_t tick = UINT64_MAX;
    bool waits = false;
    bool operator==(const Phase&) const = default;
  };
  bool judge(Phase phase, Nanoseconds overdue, Nanoseconds seen) noexcept;
  void watchEnd() noexcept;
  Nanoseconds patience(Phase phase) const noexcept;
  void watchHung(Phase phase) noexcept;
  bool mayBePaused(Phase phase, Nanoseconds stuck) const noexcept;

  Watched& servo_;
  std::function<void()> hung_, late_;
  Nanoseconds missed_after_, stuck_after_;

  Phase cut_in_;  ///< the arms were cut in that phase, once
  Phase phase_;
  Nanoseconds checks_since_cut_ = 0, checks_since_stop_ = 0;
  bool hung_told_ = false;
  Nanoseconds cpu_at_phase_ = 0;
  Nanoseconds looked_at_ = 0;  ///< the last time
  Nanoseconds counted_ = 0;    ///< time of the phase, as far as it was watched
  std::atomic<uint64_t> cuts_{0};
  std::atomic<bool> stop_{false};
  os::Thread thread_;
};

}  // namespace hapticd::watch
