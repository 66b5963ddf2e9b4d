// SPDX-License-Identifier: MIT
#include "emulators/ftdi_chip.hpp"

#include <algorithm>

namespace hapticd::emulator {
namespace {

constexpr size_t kPayload = 62;  ///< of a packet of 64 bytes
constexpr uint16_t kSlow = 0x4138, kUpload = 0x15, kFast = 0x2;
enum : uint8_t { kReset = 0, kLines = 1, kBaud = 3, kFormat = 4, kLatency = 9 };

}  // namespace

std::vector<uint8_t> falconImage() {
  std::vector<uint8_t> image(1000);
  for (size_t i = 0; i < image.size(); ++i) image[i] = static_cast<uint8_t>(i * 167 + i / 251);
  return image;
}

bool FtdiChip::control(uint8_t request, uint16_t value) {
  switch (request) {
    case kReset:
      if (value != 2) to_host_.clear();  // 1 and 2 purge one direction each
      return true;
    case kBaud:
      divisor_ = value;
      return true;
    case kLatency:
      latency_ = value * 1e-3;
      return value >= 1 && value <= 255;
    case kLines:
      // DTR from low to high at the slow rate starts the processor anew.
      if (divisor_ == kSlow && (lines_ & 1) == 0 && (value & 0x101) == 0x101) {
        state_ = State::kAsleep;
        line_.clear();
      }
      if ((value & 0x100) != 0) lines_ = static_cast<uint16_t>((lines_ & ~1) | (value & 1));
      return true;
    case kFormat:
      return true;
    default:
      return false;
  }
}

std::vector<std::vector<uint8_t>> FtdiChip::take(std::span<const uint8_t> bytes) {
  std::vector<std::vector<uint8_t>> commands;
  for (const uint8_t byte : bytes) {
    if (state_ != State::kRunning) {
      hear(byte);
      continue;
    }
    if (divisor_ != kFast) continue;  // noise at another rate
    if (byte == '<') line_.clear();
    line_.push_back(byte);
    if (line_.size() == 16 && byte == '>') commands.push_back(line_);
    if (line_.size() >= 16) line_.clear();
  }
  return commands;
}

/// The boot loader.
void FtdiChip::hear(uint8_t byte) {
  if (state_ == State::kLoading) return load(byte);
  line_.push_back(byte);
  const auto ends = [&](std::initializer_list<uint8_t> with) {
    return line_.size() >= with.size() &&
           std::equal(with.begin(), with.end(), line_.end() - static_cast<long>(with.size()));
  };
  if (divisor_ == kSlow && ends({0x0a, 0x43, 0x0d})) {
    line_.clear();
    if (deaf_ > 0) return void(--deaf_);
    state_ = State::kGreeted;
    to_host_.insert(to_host_.end(), {0x0a, 0x44, 0x2c, 0x0d});
  } else if (state_ == State::kGreeted && divisor_ == kUpload && byte == 0x41) {
    line_.clear();
    loaded_.clear();
    ++uploads_;
    state_ = State::kLoading;
    to_host_.push_back(0x41);
  }
}

/// Each byte is echoed. The processor runs what it got when that is whole and right.
void FtdiChip::load(uint8_t byte) {
  loaded_.push_back(byte);
  if (wrong_echoes_ > 0 && loaded_.size() == 100) {
    --wrong_echoes_;
    state_ = State::kAsleep;
    to_host_.push_back(static_cast<uint8_t>(~byte));
    return;
  }
  to_host_.push_back(byte);
  const std::vector<uint8_t> image = falconImage();
  if (loaded_.size() < image.size()) return;
  state_ = loaded_ == image ? State::kRunning : State::kAsleep;
  line_.clear();
}

void FtdiChip::say(std::span<const uint8_t> bytes) {
  constexpr size_t kMost = 512;  // the chip's buffer overruns: what is new is lost
  if (to_host_.size() + bytes.size() <= kMost) to_host_.insert(to_host_.end(), bytes.begin(), bytes.end());
}

void FtdiChip::advance(double seconds) {
  since_packet_ += seconds;
}

bool FtdiChip::packet(std::vector<uint8_t>& to) {
  if (to_host_.size() < kPayload && since_packet_ < latency_) return false;
  since_packet_ = 0;
  const size_t count = std::min(kPayload, to_host_.size());
  to.assign({0x31, 0x60});
  to.insert(to.end(), to_host_.begin(), to_host_.begin() + static_cast<long>(count));
  to_host_.erase(to_host_.begin(), to_host_.begin() + static_cast<long>(count));
  return true;
}

}  // namespace hapticd::emulator
