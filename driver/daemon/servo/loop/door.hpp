// SPDX-License-Identifier: MIT
/// Shows other programs more than the rows: the state of the arms, which the servo writes before it steps the shapes,
/// and a bell, which wakes waiting programs. Both are made when a program first asks for them, and stay until the run
/// ends.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "base/clock.hpp"
#include "hapticd/client.h"
#include "servo/loop/tick_log.hpp"

namespace hapticd::servo {

/// Number and time of a tick.
struct TickTime {
  uint64_t number = 0;
  Nanoseconds time = 0;
  double t = 0, dt = 0;  ///< [s] time since the first tick; [s] time since the last tick
};

class Door {
 public:
  static constexpr uint32_t kStateAt = sizeof(hapticd_state_page);  ///< [bytes] offset of the first arm
  static constexpr uint32_t kStateStride = 1152;  ///< [bytes] distance from one arm to the next: whole cache lines
  /// most programs that are woken in one tick, because waking many would delay the tick
  static constexpr int kMostWoken = 16;

  static constexpr size_t stateBytes(size_t arms) { return kStateAt + arms * kStateStride; }

  /// [any] From now on, publish() writes the state of the arms to `page`. Call it at most once. @param page
  /// stateBytes() bytes of zeros, valid until the loop has ended
  void showState(std::byte* page, uint32_t arms) noexcept;
  /// [any] From now on, publish() and written() ring `bell`. Call it at most once. @param bell zeroed, valid until the
  /// loop has ended
  void setBell(hapticd_bell* bell) noexcept { bell_.store(bell, std::memory_order_release); }

  /// [rt] Called after the arms were read: writes their state and rings the bell.
  void publish(const TickTime& tick, const Arms& arms) noexcept HSP_RT {
    if (std::byte* page = state_.load(std::memory_order_acquire); page != nullptr) write(page, tick, arms);
    if (hapticd_bell* bell = bell_.load(std::memory_order_acquire); bell != nullptr)
      ring(bell->state, bell->state_waiting, tick.number);
  }
  /// [rt] Called after the rows of the tick were written: rings the bell.
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
