// SPDX-License-Identifier: MIT
/// Time in nanoseconds since an arbitrary start, and the clocks that give it. Only the code here reads the time or
/// waits for a time. All other code gets the time as an argument, so that it can also run in virtual time, and in tests
/// without sleeping.
#pragma once
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd {

using Nanoseconds = uint64_t;

constexpr Nanoseconds kNanosecondsPerSecond = 1'000'000'000;
constexpr double kSecondsPerNanosecond = 1e-9;

/// [any] Returns the time of CLOCK_MONOTONIC, for time stamps and to measure how long a piece of work takes.
Nanoseconds monotonicNow() noexcept HSP_RT;

/// A clock that the servo loop can wait on.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual Nanoseconds now() noexcept HSP_RT = 0;
  /// [rt] Waits until `deadline`. @return the time at the end of the wait, `deadline` or later
  virtual Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT = 0;
};

/// Uses CLOCK_MONOTONIC: sleeps until `spin` before the deadline, then waits busily. Busy waiting reduces the lateness:
/// on a virtual machine, its median fell from 22 us to 0.1 us. The wait uses the share spin * rate of one CPU. The busy
/// wait must not last a whole period, or the kernel throttles the thread.
class RealClock final : public Clock {
 public:
  explicit RealClock(Nanoseconds spin) : spin_(spin) {}
  Nanoseconds now() noexcept HSP_RT override;
  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override;

 private:
  Nanoseconds spin_;
};

/// Gives virtual time: a wait ends at once, and the time is then that of the deadline.
class VirtualClock final : public Clock {
 public:
  explicit VirtualClock(Nanoseconds start = 0) : now_(start) {}
  Nanoseconds now() noexcept HSP_RT override { return now_; }
  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override {
    if (deadline > now_) now_ = deadline;
    return now_;
  }

 private:
  Nanoseconds now_;
};

}  // namespace hapticd
