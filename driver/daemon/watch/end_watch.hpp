// SPDX-License-Identifier: MIT
/// Watches the end of a run that has no watchdog, as in virtual time: one that was asked to end and whose ticks stand
/// still is ended.
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

  /// [main] @param late what ends the process
  EndWatch(const Watched& servo, std::function<void()> late) : servo_(servo), late_(std::move(late)) {}
  ~EndWatch();
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  std::error_code start();  ///< [main]
  /// [any] One look; the thread does nothing else.
  void look(Nanoseconds now) noexcept;

 private:
  void watch();

  const Watched& servo_;
  std::function<void()> late_;
  uint64_t ticks_ = UINT64_MAX;
  Nanoseconds still_since_ = 0;
  bool told_ = false, stop_ = false;
  std::mutex mutex_;
  std::condition_variable stopped_;
  os::Thread thread_;
};

}  // namespace hapticd::watch
