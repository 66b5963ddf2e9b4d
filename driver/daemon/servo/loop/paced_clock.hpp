// SPDX-License-Identifier: MIT
/// `servo.pace: device`: the samples of one arm drive the loop, and a deadline guards it.
#pragma once
#include <algorithm>
#include <memory>

#include "base/clock.hpp"
#include "base/not_real_time.hpp"
#include "host/device_instance.hpp"

namespace hapticd::servo {

/// Waits for a sample instead of a time. A silent arm delays a tick by at most one and a half periods: then the loop
/// continues and finds the sample stale. Reports that come in a burst make one tick.
class PacedClock final : public Clock {
 public:
  /// @param clock of the run; `arm` outlives this and canPace()
  PacedClock(std::unique_ptr<Clock> clock, host::DeviceInstance& arm, Nanoseconds period)
      : clock_(std::move(clock)), arm_(arm), period_(period) {}

  Nanoseconds now() noexcept HSP_RT override { return clock_->now(); }

  /// [rt] @param deadline a period after the last tick
  /// @return the time then, half a period before the deadline at the earliest
  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override {
    const NotRealTime between_ticks;
    const Nanoseconds half = period_ / 2, latest = deadline + period_ + half;
    const Nanoseconds due = std::clamp(arm_.waitForSample(latest), std::max(deadline, half) - half, latest);
    const Nanoseconds now = clock_->now();
    return due <= now ? now : clock_->waitUntil(due);
  }

 private:
  std::unique_ptr<Clock> clock_;
  host::DeviceInstance& arm_;
  Nanoseconds period_;
};

}  // namespace hapticd::servo
