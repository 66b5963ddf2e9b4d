// SPDX-License-Identifier: MIT
/// The clock for `servo.pace: device`: the samples of one arm drive the loop, and a deadline limits the wait.
#pragma once
#include <algorithm>
#include <memory>

#include "base/clock.hpp"
#include "base/not_real_time.hpp"
#include "host/device_instance.hpp"

namespace hapticd::servo {

/// Waits for a sample instead of a time. An arm without new samples delays a tick by at most one and a half periods:
/// then the loop continues with the old sample. Several samples that come together make one tick.
class PacedClock final : public Clock {
 public:
  /// @param clock clock of the run  @param arm must outlive this object, and canPace() must be true
  PacedClock(std::unique_ptr<Clock> clock, host::DeviceInstance& arm, Nanoseconds period)
      : clock_(std::move(clock)), arm_(arm), period_(period) {}

  Nanoseconds now() noexcept HSP_RT override { return clock_->now(); }

  /// [rt] @param deadline one period after the last tick
  /// @return the time of waking, at the earliest half a period before the deadline
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
