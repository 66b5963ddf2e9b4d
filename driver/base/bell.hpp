// SPDX-License-Identifier: MIT
/// Wakes one thread that sleeps until there is news, without a lock that a real-time thread could wait for.
#pragma once
#include <atomic>
#include <cstdint>

#include "base/clock.hpp"

namespace hapticd {

/// Strikes are counted: who remembers the count misses none. One thread waits.
class Bell {
 public:
  /// [rt] Strikes so far.
  uint32_t strikes() const noexcept HSP_RT { return strikes_.load(); }
  /// [rt] Counts, and wakes nobody: no system call.
  void strike() noexcept HSP_RT { strikes_.fetch_add(1); }
  /// [any] Wakes who waits; a system call only then.
  void wake() noexcept;
  /// [any] Both.
  void ring() noexcept {
    strike();
    wake();
  }
  /// [any] Sleeps until there are other strikes than `heard`, at the latest until `until` (CLOCK_MONOTONIC).
  void wait(uint32_t heard, Nanoseconds until) noexcept;

 private:
  std::atomic<uint32_t> strikes_{0}, sleeps_{0};
};

}  // namespace hapticd
