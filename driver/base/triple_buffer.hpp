// SPDX-License-Identifier: MIT
/// Passes the newest value from one writing to one reading thread. The writer never waits, the reader never sees a half
/// written value, and older values are lost.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>

#include "hapticd/abi.h"

namespace hapticd {

template <class T>
class TripleBuffer {
 public:
  /// [rt] Returns the slot that the writer fills before publish(). Only the writer may use it.
  T& back() noexcept HSP_RT { return slots_[back_].value; }

  /// [rt] Makes the back slot the newest value.
  void publish() noexcept HSP_RT { back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex; }

  /// [rt] Returns whether a new value has come since the last call. If so, front() returns the new value from now on.
  bool update() noexcept HSP_RT {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  /// [rt] Returns the value that was the newest at the last update(). Only the reader may use it.
  const T& front() const noexcept HSP_RT { return slots_[front_].value; }

 private:
  static constexpr uint32_t kFresh = 4, kIndex = 3;
  struct alignas(64) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_{};
  uint32_t back_ = 0, front_ = 1;
  std::atomic<uint32_t> middle_{2};
};

}  // namespace hapticd
