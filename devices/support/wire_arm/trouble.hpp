// SPDX-License-Identifier: MIT
/// The troubles that an arm or its connection can have, and their texts for the user.
#pragma once
#include <cstdint>

namespace hapticd::wire_arm {

enum class Trouble : uint8_t {
  kNone,
  kUnplugged,  ///< the device left the bus
  kStalled,    ///< an endpoint refuses transfers
  kBusError,   ///< transfers fail for another reason
  kFirmware,   ///< reports name another firmware version than the device file
  kShort,      ///< reports have a wrong size
  kCorrupt,    ///< reports have wrong marks, checksums or numbers
  kStale,      ///< no report came
  kSlow,       ///< reports come more slowly than the device file says
  kJump,       ///< a joint moved faster than HealthLimits::max_speed, so its encoder lost counts
  kHardware,   ///< the device reports a fault
  kAbsent,     ///< no board answers on the bus
  kTorn,       ///< every report is incomplete, because the board stopped while it wrote one
  kReset,      ///< the device restarted and forgot its positions
  kOld,        ///< the same reports come again and again, or their number does not grow
};

/// Returns a text for a trouble: what failed, and how to fix it.
const char* describe(Trouble trouble) noexcept;

}  // namespace hapticd::wire_arm
