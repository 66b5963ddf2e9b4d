// SPDX-License-Identifier: MIT
/// What the watchdog and the crash handler need of a running servo, and all they know of it.
#pragma once
#include <cstddef>
#include <cstdint>

#include "base/clock.hpp"

namespace hapticd::watch {

/// Every function is [any], lock-free and async-signal-safe.
class Watched {
 public:
  virtual ~Watched() = default;
  virtual uint64_t ticks() const noexcept = 0;         ///< done so far
  virtual Nanoseconds tickBegun() const noexcept = 0;  ///< CLOCK_MONOTONIC of the tick going on; 0: waiting for one
  virtual Nanoseconds cpuTime() const noexcept = 0;    ///< that the servo thread has used
  virtual bool simulated() const noexcept = 0;         ///< no hand can be hurt
  virtual void cut(double stuck_for) noexcept = 0;     ///< motors of every arm free, at once; stuck_for in s
  virtual const char* plugin() const noexcept = 0;     ///< whose code runs in the calling or else the servo thread
  virtual const char* model() const noexcept = 0;      ///< the model it is; nullptr: the daemon's own code
  virtual const void* blackBox() const noexcept = 0;   ///< the last seconds, as they lie in memory; nullptr: none
  virtual size_t blackBoxBytes() const noexcept = 0;
};

}  // namespace hapticd::watch
