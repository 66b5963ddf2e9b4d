// SPDX-License-Identifier: MIT
/// Passes one small record from one writer to any number of readers, in this process or in others. The writer never
/// waits. The slot is a sequence lock with atomic words: a reader gets a whole record or tries again, and a reader that
/// is killed does no harm.
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "hapticd/abi.h"

namespace hapticd::status {

template <class T>
class Slot {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 8 == 0);

 public:
  /// [rt] Writes the record. Only one thread may write.
  void write(const T& value) noexcept HSP_RT {
    const auto words = std::bit_cast<std::array<uint64_t, kWords>>(value);
    const uint64_t sequence = sequence_.load(std::memory_order_relaxed);
    sequence_.store(sequence + 1, std::memory_order_relaxed);
    // release on each word, so that a reader that sees a new word also sees the odd sequence number
    for (size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    sequence_.store(sequence + 2, std::memory_order_release);
  }

  /// [any] Returns the record. Returns nothing if the writer was writing at every try, or if it was killed while it
  /// wrote.
  std::optional<T> read() const noexcept {
    constexpr int kTries = 1000;
    for (int i = 0; i < kTries; ++i) {
      const uint64_t before = sequence_.load(std::memory_order_acquire);
      std::array<uint64_t, kWords> words;
      for (size_t w = 0; w < kWords; ++w) words[w] = words_[w].load(std::memory_order_acquire);
      if (before % 2 != 0 || sequence_.load(std::memory_order_relaxed) != before) continue;
      return std::bit_cast<T>(words);
    }
    return std::nullopt;
  }

 private:
  static constexpr size_t kWords = sizeof(T) / 8;
  std::atomic<uint64_t> sequence_{0};
  std::array<std::atomic<uint64_t>, kWords> words_{};
};

}  // namespace hapticd::status
