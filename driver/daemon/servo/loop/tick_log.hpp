// SPDX-License-Identifier: MIT
/// The interface through which the loop reports every tick and every order. An implementation writes them to files and
/// status pages.
#pragma once
#include <cstdint>

#include "base/clock.hpp"
#include "servo/arm/arm.hpp"
#include "servo/core/core.hpp"
#include "servo/core/order.hpp"

namespace hapticd::servo {

/// How long a tick took.
struct TickDuration {
  Nanoseconds total = 0;
  Nanoseconds in_arms = 0;  ///< part of `total` for the arms: physics of simulated arms, transfers of others
};

/// Every function is [rt] and called by the servo thread, in this order within a tick: begin, order (any number),
/// overrun (seldom), tick.
class TickLog {
 public:
  virtual ~TickLog() = default;

  /// A tick at time `now` begins.
  virtual void begin(Nanoseconds now, const Arms& arms) noexcept HSP_RT = 0;
  /// An order was obeyed in this tick, or the servo made a decision that depends on measured times.
  virtual void order(const Order& order) noexcept HSP_RT = 0;
  /// `missed` whole periods were skipped.
  virtual void overrun(uint64_t missed) noexcept HSP_RT = 0;
  /// The tick at t [s], dt [s] after the last one, woke `late` after its deadline and took `spent`.
  virtual void tick(double t, double dt, Nanoseconds late, const TickDuration& spent, const Core& core,
                    const Arms& arms) noexcept HSP_RT = 0;
  /// The run ended. Page faults and allocations count from the end of the warm-up.
  virtual void finish(uint64_t ticks, Nanoseconds elapsed, long page_faults, uint64_t allocations) noexcept = 0;
};

}  // namespace hapticd::servo
