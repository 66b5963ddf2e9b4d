// SPDX-License-Identifier: MIT
/// The interface by which the watchdog and the crash handler see a running servo.
#pragma once
#include <cstddef>
#include <cstdint>

#include "base/clock.hpp"
#include "base/code_owner.hpp"

namespace hapticd::watch {

/// Every function is [any], lock-free and async-signal-safe.
class WatchTarget {
 public:
  virtual ~WatchTarget() = default;
  virtual uint64_t ticks() const noexcept = 0;         ///< number of ticks so far
  virtual uint64_t beats() const noexcept = 0;         ///< number of ticks and dry cycles so far
  virtual Nanoseconds tickBegun() const noexcept = 0;  ///< CLOCK_MONOTONIC start of the tick in progress; 0: none is
  /// CLOCK_MONOTONIC time by which the next tick must have begun; 0 if there will be none.
  virtual Nanoseconds nextTick() const noexcept = 0;
  virtual Nanoseconds cpuTime() const noexcept = 0;  ///< CPU time that the servo thread has used
  virtual bool simulated() const noexcept = 0;       ///< true if all arms are simulated, so that no hand can be hurt
  virtual void stop() noexcept = 0;                  ///< asks the run to end normally: forces ramp to zero first
  /// CLOCK_MONOTONIC time at which the run was asked to end; 0 if it was not.
  virtual Nanoseconds stopAsked() const noexcept = 0;
  virtual void cut(double stuck_for) noexcept = 0;  ///< switches the motors of every arm off at once; stuck_for [s]
  virtual bool cutLeft() const noexcept = 0;        ///< false while the cut has not been sent to the hardware
  /// owner of the code that the servo thread runs; nullptr: the daemon
  virtual const Owner* inServo() const noexcept = 0;
  virtual const void* blackBox() const noexcept = 0;  ///< memory with the rows of the last seconds, or nullptr
  virtual size_t blackBoxBytes() const noexcept = 0;
  virtual bool drives() const noexcept { return true; }  ///< true if motors may be on
};

}  // namespace hapticd::watch
