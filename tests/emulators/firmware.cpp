// SPDX-License-Identifier: MIT
#include "emulators/firmware.hpp"

#include "emulators/board.hpp"

namespace hapticd::emulator {
namespace {

class Board final : public Firmware {
 public:
  std::vector<uint8_t> report(const Counts& counts, Fault fault) override {
    state_.counts = counts;
    ++state_.sequence;
    state_.version = fault == Fault::kFirmware ? 2 : 1;
    if (searching_ > 0 && --searching_ == 0) ++zeros_;
    state_.state =
        static_cast<uint8_t>((searching_ > 0 && searching_ <= kSearch ? 0 : 1) | (fault == Fault::kHardware ? 4 : 0));
    return state_.bytes();
  }
  std::optional<Currents> command(std::span<const uint8_t> bytes) override {
    const BoardCommand command(bytes);
    if (!command.valid) return std::nullopt;
    if (command.calibrate && !told_) ++searches_, searching_ = kHears + kSearch;
    told_ = command.calibrate;
    return command.enabled ? command.current : Currents{};
  }

  int searches() const override { return searches_; }
  int zeros() const override { return zeros_; }

 private:
  static constexpr int kHears = 50;    ///< reports until it begins to search
  static constexpr int kSearch = 200;  ///< reports until the hand has moved all joints past their index pulses
  BoardState state_;
  bool told_ = false;
  int searches_ = 0, zeros_ = 0, searching_ = 0;
};

class Wooden final : public Firmware {
 public:
  explicit Wooden(size_t size) : size_(size) {}
  std::vector<uint8_t> report(const Counts& counts, Fault) override {
    std::vector<uint8_t> out(size_, 0);
    for (size_t i = 0; i < 3; ++i) {
      out[2 * i] = static_cast<uint8_t>(counts[i]);
      out[2 * i + 1] = static_cast<uint8_t>(static_cast<uint32_t>(counts[i]) >> 8);
    }
    return out;
  }
  std::optional<Currents> command(std::span<const uint8_t> bytes) override {
    if (bytes.size() != size_) return std::nullopt;
    Currents current{};
    for (size_t i = 0; i < 3; ++i) current[i] = static_cast<int16_t>(bytes[2 * i] | bytes[2 * i + 1] << 8);
    return current;
  }

 private:
  size_t size_;
};

/// Each 16-bit number is four characters 'A' to 'P', the lowest four bits first.
class Falcon final : public Firmware {
 public:
  std::vector<uint8_t> report(const Counts& counts, Fault) override {
    std::vector<uint8_t> out{'<'};
    for (const int32_t count : counts)
      for (int nibble = 0; nibble < 4; ++nibble)
        out.push_back(static_cast<uint8_t>('A' + (static_cast<uint32_t>(count) >> (4 * nibble) & 15)));
    out.insert(out.end(), {'A' + 1, 'A', '>'});  // homed; no button
    return out;
  }
  std::optional<Currents> command(std::span<const uint8_t> bytes) override {
    if (bytes.size() != 16 || bytes[0] != '<' || bytes[15] != '>') return std::nullopt;
    Currents units{};
    for (size_t i = 0; i < 3; ++i) {
      unsigned word = 0;
      for (size_t nibble = 0; nibble < 4; ++nibble) {
        const int value = bytes[1 + 4 * i + nibble] - 'A';
        if (value < 0 || value > 15) return std::nullopt;
        word |= static_cast<unsigned>(value) << (4 * nibble);
      }
      units[i] = static_cast<int16_t>(word);
    }
    return units;
  }
};

}  // namespace

std::unique_ptr<Firmware> boardFirmware() {
  return std::make_unique<Board>();
}
std::unique_ptr<Firmware> woodenFirmware(size_t size) {
  return std::make_unique<Wooden>(size);
}
std::unique_ptr<Firmware> falconFirmware() {
  return std::make_unique<Falcon>();
}

}  // namespace hapticd::emulator
