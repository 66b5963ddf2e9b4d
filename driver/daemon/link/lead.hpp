// SPDX-License-Identifier: MIT
/// The servo's end of a lead: memory that a program outside writes whenever it likes, and whatever it likes. Nothing
/// that is read there is trusted, and no state of it can hold the servo up.
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "hapticd/abi.h"
#include "hapticd/client.h"

namespace hapticd::link {

constexpr double kLargestPush = 1e6;  ///< [N], [N m] a record with a larger number is refused

/// A record with a count before it that is odd while the record is written. It lives in shared memory, zeroed at first.
template <class Record>
class LeadSlot {
  static constexpr size_t kWords = sizeof(Record) / 8;
  static_assert(std::is_trivially_copyable_v<Record> && sizeof(Record) % 8 == 0);
  static_assert(std::atomic<uint64_t>::is_always_lock_free);

 public:
  /// [rt] The record, if its count is not `seen`, which then becomes that count. It tries once: if a writer was killed
  /// inside, or never stops writing, the previous record stays in force.
  bool take(uint64_t& seen, Record& record) const noexcept HSP_RT {
    const uint64_t before = count_.load(std::memory_order_acquire);
    if (before == seen || before % 2 != 0) return false;
    std::array<uint64_t, kWords> words;
    // acquire on each word: a thread that sees a word of a later record also sees that record's odd count
    for (size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
    if (count_.load(std::memory_order_relaxed) != before) return false;
    seen = before;
    record = std::bit_cast<Record>(words);
    return true;
  }

  /// [any] One writer.
  void put(const Record& record) noexcept HSP_RT {
    const auto words = std::bit_cast<std::array<uint64_t, kWords>>(record);
    const uint64_t even = (count_.load(std::memory_order_relaxed) + 1) & ~uint64_t{1};  // also after one who was killed
    count_.store(even + 1, std::memory_order_relaxed);
    for (size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    count_.store(even + 2, std::memory_order_release);
  }

 private:
  std::atomic<uint64_t> count_{0};
  std::array<std::atomic<uint64_t>, kWords> words_{};
};

using PoseSlot = LeadSlot<hapticd_target>;
using PushSlot = LeadSlot<hapticd_push>;

/// What the servo tells programs that push: here the servo writes and they read.
using StateSlot = LeadSlot<hapticd_state>;
using JacobianSlot = LeadSlot<hapticd_jacobian>;
constexpr size_t kJacobianAt = 320;  ///< [bytes] offset of an arm's Jacobian from the beginning of its state
static_assert(sizeof(StateSlot) <= kJacobianAt);

static_assert(sizeof(PoseSlot) <= sizeof(hapticd_lead_page) && sizeof(PushSlot) <= sizeof(hapticd_lead_page));
static_assert(sizeof(PoseSlot) == offsetof(hapticd_lead_page, words) + sizeof(hapticd_target));
static_assert(sizeof(PushSlot) == offsetof(hapticd_lead_page, words) + sizeof(hapticd_push));

}  // namespace hapticd::link
