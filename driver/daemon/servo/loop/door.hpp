// SPDX-License-Identifier: MIT
/// What the loop tells programs outside beside the rows: the state of the arms before the shapes are felt, and a bell
/// that wakes who waits. Neither exists until somebody asks, and then it stays until the end of the run.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "base/clock.hpp"
#include "hapticd/client.h"
#include "servo/loop/tick_log.hpp"

namespace hapticd::servo {

/// When a tick is.
struct TickTime {
  uint64_t number = 0;
  Nanoseconds time = 0;
  double t = 0, dt = 0;  ///< [s]
};

class Door {
 public:
  static constexpr uint32_t kStateAt = sizeof(hapticd_state_page);  ///< [bytes] of the first arm
  static constexpr uint32_t kStateStride = 1152;                    ///< [bytes] whole cache lines
  static constexpr int kMostWoken = 16;  ///< programs woken at a time: a crowd that waits must not delay a tick

  static constexpr size_t stateBytes(size_t arms) { return kStateAt + arms * kStateStride; }

  /// [any] Only one thread, and only once. @param page zeroed, of stateBytes(), valid until the loop has ended
  void showState(std::byte* page, uint32_t arms) noexcept;
  /// [any] Only one thread, and only once. @param bell zeroed, valid until the loop has ended
  void hangBell(hapticd_bell* bell) noexcept { bell_.store(bell, std::memory_order_release); }

  /// [rt] The arms were read.
  void tell(const TickTime& tick, const Arms& arms) noexcept HSP_RT {
    if (std::byte* page = state_.load(std::memory_order_acquire); page != nullptr) write(page, tick, arms);
    if (hapticd_bell* bell = bell_.load(std::memory_order_acquire); bell != nullptr)
      ring(bell->state, bell->state_waiting, tick.number);
  }
  /// [rt] The rows of the tick are written.
  void written(uint64_t tick) noexcept HSP_RT {
    if (hapticd_bell* bell = bell_.load(std::memory_order_acquire); bell != nullptr)
      ring(bell->rows, bell->rows_waiting, tick);
  }

 private:
  static void write(std::byte* page, const TickTime& tick, const Arms& arms) noexcept HSP_RT;
  static void ring(uint32_t& word, uint32_t& waiting, uint64_t tick) noexcept HSP_RT;

  std::atomic<std::byte*> state_{nullptr};
  std::atomic<hapticd_bell*> bell_{nullptr};
};

}  // namespace hapticd::servo
