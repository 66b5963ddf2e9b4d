// SPDX-License-Identifier: MIT
/// The mailbox that the host and an arm controller board share: two blocks in a window of the bus, without a lock. A
/// block has a sequence number at its beginning and one at its end. The writer writes the number at the end last. The
/// reader reads the number at the end first, and then the block. The block is complete if both of its numbers equal the
/// number that was read first.
#pragma once
#include <array>

#include "vme/window.hpp"
#include "wire_arm/transport.hpp"

namespace hapticd::vme {

struct MailboxPlace {
  Place window;
  uint64_t state = 0, command = 0x100;  ///< offsets in the window: block from the board, block to the board
  Nanoseconds poll = 100'000;           ///< [ns] time between two reads of the state block
};

/// Polls for new blocks, because programs cannot get interrupts of the bus through vme_user.
class Mailbox final : public wire_arm::Transport {
 public:
  explicit Mailbox(const MailboxPlace& place) : place_(place) {}

  Result<wire_arm::Identity> open(const wire_arm::Address& address, const codec::Wire& wire) override;
  void close() noexcept override { window_.close(); }
  /// Waits at most until the next poll, so that a command never waits for the next state block.
  wire_arm::Status receive(std::span<uint8_t> to, size_t& size, Nanoseconds wait) noexcept override;
  wire_arm::Status send(std::span<const uint8_t> bytes) noexcept override;
  bool sharesMemory() const noexcept override { return true; }
  /// Gives access to the command block through another descriptor of the same window.
  Descriptor openForSilence(hdv_silence& how) noexcept override;
  wire_arm::Status control(const codec::StartStep&) noexcept override { return wire_arm::Status::kFailed; }

 private:
  struct Number {
    size_t at = 0, bytes = 0;  ///< place and size of a sequence number in the state block; size 0 if there is none
  };
  void findNumbers(const codec::Report& report);
  wire_arm::Status look(std::span<uint8_t> block) noexcept;
  wire_arm::Status take(std::span<uint8_t> block) noexcept;

  MailboxPlace place_;
  Window window_;
  Number first_, last_;
  size_t block_bytes_ = 0;
  std::array<uint8_t, 8> seen_{};  ///< the number of the newest whole block
  bool have_seen_ = false;
  bool alive_ = false;  // the board's sequence number has changed since the window was opened
  Nanoseconds looked_at_ = 0;
};

/// [main] Returns an error if the blocks do not fit into the window.
Result<void> check(const MailboxPlace& place, const codec::Wire& wire);

}  // namespace hapticd::vme
