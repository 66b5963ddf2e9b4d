// SPDX-License-Identifier: MIT
/// A bounded queue between one writing and one reading thread. It has no lock, allocates only at construction, and
/// keeps the order.
#pragma once
#include <atomic>
#include <bit>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "hapticd/abi.h"

namespace hapticd {

template <class T>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>, "entries are copied by both threads");

 public:
  /// [main] @param capacity largest number of values, which is rounded up to a power of two
  explicit SpscRing(size_t capacity) : slots_(std::bit_ceil(capacity)), mask_(slots_.size() - 1) {}

  /// [rt] Appends a value. Returns false and writes nothing if the ring is full.
  bool push(const T& value) noexcept HSP_RT {
    const bool added = add(value);
    publish();
    return added;
  }

  /// [rt] Appends a value that the reader sees only after publish(), together with all others of its kind. Returns
  /// false and writes nothing if the ring is full.
  bool add(const T& value) noexcept HSP_RT {
    if (written_ - tail_.load(std::memory_order_acquire) == slots_.size()) return false;
    slots_[written_++ & mask_] = value;
    return true;
  }
  /// [rt] Shows the reader all values that add() has appended.
  void publish() noexcept HSP_RT { head_.store(written_, std::memory_order_release); }

  /// [rt] Takes the oldest value. Returns false if the ring is empty.
  bool pop(T& value) noexcept HSP_RT {
    const size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    value = slots_[tail & mask_];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

 private:
  std::vector<T> slots_;
  size_t mask_;
  alignas(64) std::atomic<size_t> head_{0};  ///< count of the values that the reader may see
  size_t written_ = 0;                       ///< count of the values that were appended, known to the writer only
  alignas(64) std::atomic<size_t> tail_{0};
};

}  // namespace hapticd
