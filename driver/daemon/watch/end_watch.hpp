// SPDX-License-Identifier: MIT
/// Watches a run that has no watchdog, as in virtual time: one that was asked to end and whose ticks stand still is
/// ended, and so is one whose tick does not come back, asked or not.
#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <system_error>

#include "base/os.hpp"
#include "watch/watched.hpp"

namespace hapticd::watch {

class EndWatch {
 public:
  static constexpr Nanoseconds kLookEvery = 50'000'000;
  static constexpr Nanoseconds kEndWithin = 900'000'000;  ///< [ns] without a tick, from the moment it was asked to end

  /// [ns] of processor time in one tick: no shape that is felt takes so long, and a slow machine does not lengthen it.
  static constexpr Nanoseconds kHungAfter = 5'000'000'000;
  /// [ns] of looks at one tick that waits for something, such as a lock or a file.
  static constexpr Nanoseconds kWaitsAfter = 30'000'000'000;
  /// [ns] of looks at the calls after the last tick: a module may wait there for a thread of its own.
  static constexpr Nanoseconds kWaitsForLast = 10'000'000'000;

  /// [main] @param late what ends the process that was asked to end @param hung what ends one whose tick hangs; it
  /// returns if it finds nobody to blame, and is asked again
  EndWatch(const Watched& servo, std::function<void()> late, std::function<void()> hung)
      : servo_(servo), late_(std::move(late)), hung_(std::move(hung)) {}
  ~EndWatch();
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  std::error_code start();  ///< [main]
  /// [main] No tick is to come: what still is called, such as stop() of the arms, has kWaitsForLast.
  /// @param stuck ends the process after that; it returns if it finds nobody to blame, and is asked again
  void lastCalls(std::function<void()> stuck);
  /// [any] One look; the thread does nothing else.
  void look(Nanoseconds now) noexcept;

 private:
  void watch();
  void lookForHang(uint64_t ticks) noexcept;

  const Watched& servo_;
  std::function<void()> late_, hung_, stuck_;
  uint64_t ticks_ = UINT64_MAX;
  Nanoseconds still_since_ = 0;
  Nanoseconds looked_last_ = 0;  ///< at the calls after the last tick
  Nanoseconds tick_begun_ = 0;
  Nanoseconds looked_ = 0, cpu_before_ = 0;  ///< of this tick; of the servo when it was first seen
  bool told_ = false, stop_ = false;
  std::mutex mutex_;
  std::condition_variable stopped_;
  os::Thread thread_;
};

}  // namespace hapticd::watch
