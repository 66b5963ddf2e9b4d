// SPDX-License-Identifier: MIT
/// What one arm gave to the hand over a run.
#pragma once
#include <algorithm>
#include <cstdint>

#include "hapticd/abi.h"
#include "servo/arm/arm.hpp"

namespace hapticd::servo {

struct SentForce {
  double largest = 0;        ///< [N]
  uint64_t fault_ticks = 0;  ///< ticks in which a fault kept the force away
  uint64_t not_enabled = 0;  ///< ticks in which the enable switch alone kept it away

  /// [rt] Adds a tick.
  void add(const Arm& arm) noexcept HSP_RT {
    const Fault fault = arm.limiter().fault();
    largest = std::max(largest, arm.force().norm());
    fault_ticks += fault != Fault::kNone && fault != Fault::kStopped ? 1 : 0;
    not_enabled += fault == Fault::kNone && !arm.limiter().enabled() ? 1 : 0;
  }
};

}  // namespace hapticd::servo
