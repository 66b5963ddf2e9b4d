// SPDX-License-Identifier: MIT
/// What the watchdog and the crash handler need of a running servo, and all they know of it.
#pragma once
#include <cstddef>
#include <cstdint>

#include "base/blame.hpp"
#include "base/clock.hpp"

namespace hapticd::watch {

/// Every function is [any], lock-free and async-signal-safe.
class Watched {
 public:
  virtual ~Watched() = default;
  virtual uint64_t ticks() const noexcept = 0;         ///< done so far
  virtual Nanoseconds tickBegun() const noexcept = 0;  ///< CLOCK_MONOTONIC of the tick in progress; 0: waiting for one
  /// CLOCK_MONOTONIC by which the next tick must have begun; 0: none is to come.
  virtual Nanoseconds nextTick() const noexcept = 0;
  virtual Nanoseconds cpuTime() const noexcept = 0;  ///< CPU time that the servo thread has used
  virtual bool simulated() const noexcept = 0;       ///< no hand can be hurt
  virtual void stop() noexcept = 0;                  ///< ends the run in order: forces ramp to zero first
  /// CLOCK_MONOTONIC when the end was asked for; 0: it was not.
  virtual Nanoseconds stopAsked() const noexcept = 0;
  virtual void cut(double stuck_for) noexcept = 0;    ///< frees the motors of every arm at once; stuck_for in s
  virtual bool cutLeft() const noexcept = 0;          ///< the cut is on its way to the hardware, or nobody knows
  virtual const Owner* inServo() const noexcept = 0;  ///< whose code the servo thread runs; nullptr: the daemon's own
  virtual const void* blackBox() const noexcept = 0;  ///< the last seconds as they lie in memory; nullptr: none
  virtual size_t blackBoxBytes() const noexcept = 0;
  virtual bool drives() const noexcept { return true; }  ///< motors may be on
};

}  // namespace hapticd::watch
