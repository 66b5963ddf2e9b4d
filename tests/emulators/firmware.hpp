// SPDX-License-Identifier: MIT
/// What an arm's own processor says and understands: counts become reports, commands become motor currents. Each is
/// written down here a second time, by hand, so that a mistake in a device file meets something that disagrees.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace hapticd::emulator {

using Counts = std::array<int32_t, 3>;
using Currents = std::array<int16_t, 3>;  ///< mA, or the Falcon's units

/// What an emulator can be told to do wrong. Stale: the last report again and again. Stalled: the endpoint in
/// is halted until the host clears it, after this has ended.
enum class Fault { kNone, kSilent, kShort, kCorrupt, kFirmware, kHardware, kJump, kHalfRate, kStale, kStalled };

class Firmware {
 public:
  virtual ~Firmware() = default;
  virtual std::vector<uint8_t> report(const Counts& counts, Fault fault) = 0;
  /// Nothing: no good command, which a firmware ignores.
  virtual std::optional<Currents> command(std::span<const uint8_t> bytes) = 0;
  /// How often it was told to search its zero.
  virtual int searches() const { return 0; }
  virtual int zeros() const { return 0; }
};

/// The open interface board (driver/docs/usb_interface_board.md).
std::unique_ptr<Firmware> boardFirmware();
/// WoodenHaptics' and Polhem's boards: seven 16-bit numbers in reports of `size` bytes.
std::unique_ptr<Firmware> woodenFirmware(size_t size);
/// The Novint Falcon once its firmware runs: 16 characters between < and >.
std::unique_ptr<Firmware> falconFirmware();

}  // namespace hapticd::emulator
