// SPDX-License-Identifier: MIT
/// Wakes one thread that sleeps until there is news, without a lock that a real-time thread could wait for.
#pragma once
#include <atomic>
#include <cstdint>

#include "base/clock.hpp"

namespace hapticd {

/// A bell that one thread waits for. Each strike of the bell says that there is news. The strikes are counted, so a
/// thread that remembers the count misses none.
class Bell {
 public:
  /// [rt] Returns the number of strikes so far.
  uint32_t strikes() const noexcept HSP_RT { return strikes_.load(); }
  /// [rt] Counts a strike, but wakes nobody, so it makes no system call.
  void strike() noexcept HSP_RT { strikes_.fetch_add(1); }
  /// [any] Wakes the waiting thread, but counts no strike. It makes a system call only if a thread waits.
  void wake() noexcept;
  /// [any] Calls strike() and wake().
  void ring() noexcept {
    strike();
    wake();
  }
  /// [any] Sleeps until the count of strikes differs from `heard`, and at the latest until the time `until`
  /// (CLOCK_MONOTONIC).
  void wait(uint32_t heard, Nanoseconds until) noexcept;

 private:
  std::atomic<uint32_t> strikes_{0}, sleeps_{0};
};

}  // namespace hapticd
