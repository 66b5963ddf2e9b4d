// SPDX-License-Identifier: MIT
/// The servo's side of a lead. A lead is memory that another program may write at any time. The servo does not trust
/// what it reads there, and whatever the program writes, the servo never waits for it.
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

constexpr double kLargestPush = 1e6;  ///< [N] or [N m] a record with a larger number is refused

/// A record in shared memory with a count before it (a seqlock): the count is odd while the record is being written.
/// The memory is zeroed at first.
template <class Record>
class LeadSlot {
  static constexpr size_t kWords = sizeof(Record) / 8;
  static_assert(std::is_trivially_copyable_v<Record> && sizeof(Record) % 8 == 0);
  static_assert(std::atomic<uint64_t>::is_always_lock_free);

 public:
  /// [rt] Reads the record if its count differs from `seen`, and sets `seen` to its count. It tries only once: if the
  /// writer was killed while it wrote, or never stops writing, it returns false, and the previous record stays in use.
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

  /// [any] Writes the record. There must be only one writer.
  void put(const Record& record) noexcept HSP_RT {
    const auto words = std::bit_cast<std::array<uint64_t, kWords>>(record);
    // even, also if a writer was killed while the count was odd
    const uint64_t even = (count_.load(std::memory_order_relaxed) + 1) & ~uint64_t{1};
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

/// State for programs that push on an arm. Here the servo writes, and the programs read.
using StateSlot = LeadSlot<hapticd_state>;
using JacobianSlot = LeadSlot<hapticd_jacobian>;
constexpr size_t kJacobianAt = 320;  ///< [bytes] offset of an arm's Jacobian from the beginning of its state
static_assert(sizeof(StateSlot) <= kJacobianAt);

static_assert(sizeof(PoseSlot) <= sizeof(hapticd_lead_page) && sizeof(PushSlot) <= sizeof(hapticd_lead_page));
static_assert(sizeof(PoseSlot) == offsetof(hapticd_lead_page, words) + sizeof(hapticd_target));
static_assert(sizeof(PushSlot) == offsetof(hapticd_lead_page, words) + sizeof(hapticd_push));

}  // namespace hapticd::link
