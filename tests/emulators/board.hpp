// SPDX-License-Identifier: MIT
/// The device side of the interface board's reports, written down a second time by hand:
/// driver/docs/usb_interface_board.md.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace hapticd::emulator {

inline uint16_t boardCrc(std::span<const uint8_t> bytes) {
  uint16_t crc = 0xffff;
  for (const uint8_t byte : bytes)
    for (int bit = 7; bit >= 0; --bit) {
      const bool high = (crc >> 15 & 1) != (byte >> bit & 1);
      crc = static_cast<uint16_t>(crc << 1);
      if (high) crc ^= 0x1021;
    }
  return crc;
}

struct BoardState {
  std::array<int32_t, 3> counts{};
  uint16_t sequence = 0;
  uint8_t version = 1, buttons = 0, state = 1;  ///< state: bit 0 calibrated, 2 amplifier fault, 3 too hot

  std::vector<uint8_t> bytes() const {
    std::vector<uint8_t> out(32, 0);
    out[0] = version, out[1] = buttons;
    out[2] = static_cast<uint8_t>(sequence), out[3] = static_cast<uint8_t>(sequence >> 8);
    for (size_t i = 0; i < 3; ++i)
      for (size_t b = 0; b < 4; ++b)
        out[8 + 4 * i + b] = static_cast<uint8_t>(static_cast<uint32_t>(counts[i]) >> (8 * b));
    out[26] = state;
    const uint16_t crc = boardCrc({out.data(), 30});
    out[30] = static_cast<uint8_t>(crc), out[31] = static_cast<uint8_t>(crc >> 8);
    return out;
  }
};

struct BoardCommand {
  bool valid = false, enabled = false, calibrate = false;
  std::array<int16_t, 3> current{};  ///< mA

  explicit BoardCommand(std::span<const uint8_t> bytes) {
    if (bytes.size() != 16 || bytes[0] != 1) return;
    if (boardCrc(bytes.first(14)) != (bytes[14] | bytes[15] << 8)) return;
    valid = true;
    enabled = (bytes[1] & 1) != 0;
    calibrate = (bytes[1] & 2) != 0;
    for (size_t i = 0; i < 3; ++i) current[i] = static_cast<int16_t>(bytes[4 + 2 * i] | bytes[5 + 2 * i] << 8);
  }
  bool pushes() const { return enabled && (current[0] != 0 || current[1] != 0 || current[2] != 0); }
};

}  // namespace hapticd::emulator
