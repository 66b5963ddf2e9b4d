// SPDX-License-Identifier: MIT
#include "vme/mailbox.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cstring>

namespace hapticd::vme {
namespace {

using wire_arm::Status;
constexpr int kTries = 3;  ///< attempts to read a block while the board writes it

/// Returns whether all bytes are 0xff. This happens if no board answers: all lines of the bus stay high, and vme_user
/// reports no error.
bool nobody(std::span<const uint8_t> bytes) noexcept {
  return std::all_of(bytes.begin(), bytes.end(), [](uint8_t byte) { return byte == 0xff; });
}

/// Checks the two blocks. @param sized false if the size of the window is wrong, so that nothing can be beyond its end
Result<void> checkBlocks(const MailboxPlace& place, const codec::Wire& wire, bool sized) {
  const uint64_t in = wire.input.size, out = wire.output.size, width = place.window.width;
  const auto outside = [&](uint64_t at, uint64_t bytes) {
    return at > place.window.size || bytes > place.window.size - at;
  };
  if (sized && (outside(place.state, in) || outside(place.command, out)))
    return Error{"vme.state, vme.command: the blocks end beyond the window's " + std::to_string(place.window.size) +
                 " bytes; correct the offsets, or make vme.size larger"};
  if (place.state < place.command + out && place.command < place.state + in)
    return Error{"vme.command: the block of " + std::to_string(out) + " bytes overlaps the state block of " +
                 std::to_string(in) + " bytes; correct vme.state or vme.command"};
  if (place.state % width != 0 || place.command % width != 0 || in % width != 0 || out % width != 0)
    return Error{"vme.state, vme.command: an offset or size is not a multiple of " + std::to_string(width) +
                 " bytes; expected whole words of vme.width"};
  if (wire.framing.used || wire.input.id >= 0 || wire.output.id >= 0 || !wire.startup.empty())
    return Error{"wire: has framing, startup or a report id, which a mailbox on a bus cannot use\n  fix: remove them"};
  return {};
}

}  // namespace

Result<void> check(const MailboxPlace& place, const codec::Wire& wire) {
  const auto window = check(place.window);
  auto blocks = checkBlocks(place, wire, static_cast<bool>(window));
  if (window || blocks) return window ? blocks : window;
  return Error{window.error() + "\n" + blocks.error()};  // one problem a line
}

void Mailbox::findNumbers(const codec::Report& report) {
  first_ = last_ = {};
  for (const codec::Field& field : report.fields) {
    if (field.role != codec::Role::kSequence) continue;
    const Number number{field.at, field.bytes()};
    if (first_.bytes == 0 || number.at < first_.at) first_ = number;
    if (last_.bytes == 0 || number.at > last_.at) last_ = number;
  }
  if (first_.bytes != last_.bytes) first_ = last_;  // the codec compares two numbers of different sizes
  block_bytes_ = report.size;
}

Result<wire_arm::Identity> Mailbox::open(const wire_arm::Address&, const codec::Wire& wire) {
  if (auto opened = window_.open(place_.window); !opened) return Error{opened.error()};
  findNumbers(wire.input);
  std::array<uint8_t, codec::kMaxReportBytes> block{};
  const long got = window_.read(place_.state, {block.data(), block_bytes_});
  const std::string where = describe(place_.window);
  std::string wrong;
  if (got < 0) wrong = "cannot be read: " + std::string(std::strerror(errno));
  if (got == 0) wrong = "is not there: the window returns no bytes";
  if (got > 0 && got < static_cast<long>(block_bytes_)) wrong = "ends after " + std::to_string(got) + " bytes";
  if (got == static_cast<long>(block_bytes_) && nobody({block.data(), block_bytes_}))
    wrong = "reads 0xff in every byte: no board answers on the bus";
  if (!wrong.empty()) {
    window_.close();
    return Error{
        "the mailbox at " + where + " " + wrong +
        "\n  the arm stays off\n  fix: switch the rack and its controller board on, or correct the vme keys of "
        "the device file"};
  }
  // The block may be left from a board that has stopped, so only a newer block counts.
  std::memcpy(seen_.data(), block.data() + last_.at, last_.bytes);
  have_seen_ = last_.bytes > 0;
  alive_ = !have_seen_;
  wire_arm::Identity identity;
  identity.product =
      window_.isFile() ? "controller board, in a plain file instead of a bus" : "controller board, " + where;
  identity.serial =
      place_.window.node.substr(place_.window.node.find_last_of('/') + 1) + "-" + where.substr(0, where.find(" ("));
  std::replace(identity.serial.begin(), identity.serial.end(), ' ', '-');
  identity.epoch = "since the boot";
  return identity;
}

Status Mailbox::receive(std::span<uint8_t> to, size_t& size, Nanoseconds wait) noexcept {
  size = 0;
  if (to.size() < block_bytes_) return Status::kFailed;
  if (wait > 0) {
    RealClock clock(0);
    const Nanoseconds now = clock.now();
    clock.waitUntil(std::min(now + wait, std::max(now, looked_at_ + place_.poll)));
  }
  looked_at_ = monotonicNow();
  const Status status = look(to.first(block_bytes_));
  if (status == Status::kOk) size = block_bytes_;
  return status;
}

Status Mailbox::look(std::span<uint8_t> block) noexcept {
  if (last_.bytes == 0) return take(block);
  std::array<uint8_t, 8> number{};
  const std::span<uint8_t> last(number.data(), last_.bytes);
  for (int attempt = 0; attempt < kTries; ++attempt) {
    if (window_.read(place_.state + last_.at, last) != static_cast<long>(last.size())) return Status::kFailed;
    if (have_seen_ && !nobody(last) && std::memcmp(last.data(), seen_.data(), last.size()) == 0)
      return Status::kNothing;
    if (const Status status = take(block); status != Status::kOk) return status;
    const bool whole = std::memcmp(block.data() + first_.at, last.data(), last.size()) == 0 &&
                       std::memcmp(block.data() + last_.at, last.data(), last.size()) == 0;
    if (!whole) continue;
    const bool old = have_seen_ && std::memcmp(last.data(), seen_.data(), last.size()) == 0;
    seen_ = number;
    have_seen_ = true;
    alive_ |= !old;
    return old ? Status::kNothing : Status::kOk;
  }
  return Status::kOk;  // incomplete block: the codec sees that its numbers differ, and the session reports this
}

Status Mailbox::take(std::span<uint8_t> block) noexcept {
  if (window_.read(place_.state, block) != static_cast<long>(block.size())) return Status::kFailed;
  return nobody(block) ? Status::kAbsent : Status::kOk;
}

/// Opens the window a second time. Link::silence() uses it only after the board has sent a report, because a wrong
/// address may be memory of another board.
Descriptor Mailbox::openForSilence(hdv_silence& how) noexcept {
  how.kind = HDV_BY_PWRITE;
  how.offset = place_.command;
  return Descriptor(::open(place_.window.node.c_str(), O_RDWR | O_CLOEXEC));
}

Status Mailbox::send(std::span<const uint8_t> bytes) noexcept {
  if (!alive_) return Status::kOk;  // a wrong address may be memory of another board
  return window_.write(place_.command, bytes) == static_cast<long>(bytes.size()) ? Status::kOk : Status::kFailed;
}

}  // namespace hapticd::vme
