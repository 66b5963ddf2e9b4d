// SPDX-License-Identifier: MIT
/// The mailbox that the host and an arm controller board share: two blocks in a window of the bus. Nothing locks it.
/// Who writes a block writes its last sequence number last; who reads takes the last number first, then the block, and
/// the block is whole if its first number is the same.
#pragma once
#include <array>

#include "vme/window.hpp"
#include "wire_arm/transport.hpp"

namespace hapticd::vme {

struct MailboxPlace {
  Place window;
  uint64_t state = 0, command = 0x100;  ///< offsets of the blocks from board to host and from host to board
  Nanoseconds poll = 100'000;           ///< time between two looks at the state block
};

/// Looks for new blocks by polling: no interrupt of the bus reaches a program through vme_user.
class Mailbox final : public wire_arm::Transport {
 public:
  explicit Mailbox(const MailboxPlace& place) : place_(place) {}

  Result<wire_arm::Identity> open(const wire_arm::Address& address, const codec::Wire& wire) override;
  void close() noexcept override { window_.close(); }
  /// Waits at most for the next look, so that a command never waits for a state.
  wire_arm::Status receive(std::span<uint8_t> to, size_t& size, Nanoseconds wait) noexcept override;
  wire_arm::Status send(std::span<const uint8_t> bytes) noexcept override;
  /// The command block, through another descriptor of the same window.
  Descriptor wayIn(hdv_silence& how) noexcept override;
  wire_arm::Status control(const codec::StartStep&) noexcept override { return wire_arm::Status::kFailed; }

 private:
  struct Number {
    size_t at = 0, bytes = 0;  ///< place of a sequence number inside the state block; no bytes: it has none
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
  bool alive_ = false;  // the board has counted since the window was opened
  Nanoseconds looked_at_ = 0;
};

/// [main] Nothing, or the reason why the blocks cannot be in the window.
Result<void> check(const MailboxPlace& place, const codec::Wire& wire);

}  // namespace hapticd::vme
