// SPDX-License-Identifier: MIT
/// Counts the ticks of commands that run the core without a servo loop, such as trace and tune, so that another thread
/// can see a tick that does not return.
#pragma once
#include <atomic>
#include <cstdint>

namespace hapticd {

namespace detail {
inline std::atomic<uint64_t> offline_begun{0}, offline_ended{0};
}

/// Counts a tick: its constructor counts the beginning, its destructor the end.
class OfflineTick {
 public:
  OfflineTick() noexcept { count(detail::offline_begun); }
  ~OfflineTick() { count(detail::offline_ended); }
  OfflineTick(const OfflineTick&) = delete;
  OfflineTick& operator=(const OfflineTick&) = delete;

  static uint64_t ended() noexcept { return detail::offline_ended.load(std::memory_order_relaxed); }
  /// Returns the number of the tick in progress, counted from 1, or 0 if no tick is in progress.
  static uint64_t current() noexcept {
    const uint64_t begun = detail::offline_begun.load(std::memory_order_relaxed);
    return begun != ended() ? begun : 0;
  }

 private:
  /// Adds 1. An atomic addition is not needed, because only one thread at a time runs such ticks.
  static void count(std::atomic<uint64_t>& number) noexcept {
    number.store(number.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
};

}  // namespace hapticd
