// SPDX-License-Identifier: MIT
/// What can go wrong between a healthy arm and the servo, and what to tell the user about it.
#pragma once
#include <cstdint>

namespace hapticd::wire_arm {

enum class Trouble : uint8_t {
  kNone,
  kUnplugged,  ///< the device left the bus
  kStalled,    ///< an endpoint refuses transfers
  kBusError,   ///< transfers fail for another reason
  kFirmware,   ///< reports have a version that the device file does not describe
  kShort,      ///< reports have a wrong size
  kCorrupt,    ///< reports have wrong marks, checksums or numbers
  kStale,      ///< no report came, or the same one came again and again
  kSlow,       ///< fewer reports come than the device file says
  kJump,       ///< a joint moved further than any hand moves it
  kHardware,   ///< the device reports a fault
  kAbsent,     ///< nobody answers on the bus
  kTorn,       ///< reports are never whole
  kReset,      ///< the device restarted and forgot where it was
};

/// Words for a trouble: what failed, and what cures it.
const char* describe(Trouble trouble) noexcept;

}  // namespace hapticd::wire_arm
