// SPDX-License-Identifier: MIT
/// Numbers keys in the order in which they are met, so that the numbers do not depend on the machine.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hapticd::drawing {

class Numbering {
 public:
  using Key = std::array<std::uint32_t, 3>;

  /// [any] @param most largest number of different keys
  explicit Numbering(std::size_t most) : slots_(std::bit_ceil(2 * most + 1), kFree), mask_(slots_.size() - 1) {}

  /// [any] Returns the number of a key. A new key gets the next number, counted from 0.
  std::uint32_t operator()(const Key& key) {
    std::size_t slot = hashOf(key) & mask_;
    while (slots_[slot] != kFree && keys_[slots_[slot]] != key) slot = (slot + 1) & mask_;
    if (slots_[slot] == kFree) {
      slots_[slot] = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return slots_[slot];
  }
  std::size_t count() const { return keys_.size(); }  ///< [any] number of different keys so far

 private:
  static constexpr std::uint32_t kFree = UINT32_MAX;
  /// Mixes the bits of a key (the finisher of MurmurHash3 by Austin Appleby, in the public domain).
  static std::size_t hashOf(const Key& key) {
    std::uint64_t hash = 0;
    for (const std::uint32_t word : key) {
      hash = (hash ^ word) * 0xff51afd7ed558ccdu;
      hash ^= hash >> 33;
    }
    return static_cast<std::size_t>(hash);
  }

  std::vector<std::uint32_t> slots_;
  std::size_t mask_;
  std::vector<Key> keys_;
};

}  // namespace hapticd::drawing
