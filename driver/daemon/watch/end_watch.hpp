// SPDX-License-Identifier: MIT
/// Watches a run without a watchdog, as in virtual time. It ends a run that was asked to end but makes no more ticks,
/// and any run with a tick that does not return.
#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <system_error>

#include "base/os.hpp"
#include "watch/watch_target.hpp"

namespace hapticd::watch {

class EndWatch {
 public:
  static constexpr Nanoseconds kLookEvery = 50'000'000;
  /// [ns] longest time without a tick after the run was asked to end
  static constexpr Nanoseconds kEndWithin = 900'000'000;

  /// [ns] longest processor time of a tick. No useful shape takes this long, and processor time does not grow on a busy
  /// machine.
  static constexpr Nanoseconds kHungAfter = 5'000'000'000;
  /// [ns] longest time of a tick that waits for something, such as a lock or a file, counted in calls of check().
  static constexpr Nanoseconds kWaitsAfter = 30'000'000'000;
  /// [ns] longest time of the calls after the last tick, in which a module may wait for its own threads, counted in
  /// calls of check().
  static constexpr Nanoseconds kWaitsForLast = 10'000'000'000;

  /// [main] @param late ends a process that was asked to end @param hung ends a process whose tick hangs; if it finds
  /// no code to blame, it returns and is called again later
  EndWatch(const WatchTarget& servo, std::function<void()> late, std::function<void()> hung)
      : servo_(servo), late_(std::move(late)), hung_(std::move(hung)) {}
  ~EndWatch();
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  std::error_code start();  ///< [main]
  /// [main] Called after the last tick. The calls that follow, such as stop() of the arms, may take kWaitsForLast.
  /// @param stuck ends the process after that time; if it finds no code to blame, it returns and is called again later
  void lastCalls(std::function<void()> stuck);
  /// [any] Checks the servo once. The thread of this object only calls this function, once every kLookEvery.
  void check(Nanoseconds now) noexcept;

 private:
  void watch();
  void checkForHang(uint64_t ticks) noexcept;

  const WatchTarget& servo_;
  std::function<void()> late_, hung_, stuck_;
  uint64_t ticks_ = UINT64_MAX;
  Nanoseconds still_since_ = 0;
  Nanoseconds looked_last_ = 0;  ///< [ns] duration of the calls after the last tick, as far as it was watched
  Nanoseconds tick_begun_ = 0;
  /// looked_: [ns] duration of this tick, as far as it was watched. cpu_before_: [ns] CPU time of the servo before this
  /// tick
  Nanoseconds looked_ = 0, cpu_before_ = 0;
  bool told_ = false, stop_ = false;
  std::mutex mutex_;
  std::condition_variable stopped_;
  os::Thread thread_;
};

}  // namespace hapticd::watch
