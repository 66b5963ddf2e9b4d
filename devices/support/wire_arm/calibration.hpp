// SPDX-License-Identifier: MIT
/// Stores zero positions in a file, for arms whose encoders count from the position in which they were switched on. A
/// stored zero becomes invalid when the arm is plugged in again or the machine is booted.
#pragma once
#include <filesystem>

#include "wire_arm/link.hpp"

namespace hapticd::wire_arm {

/// [main] Returns the first of these folders whose variable is set: $STATE_DIRECTORY, $XDG_STATE_HOME/hapticd,
/// ~/.local/state/hapticd.
std::filesystem::path stateFolder();

/// [main] Writes the zero offsets of `count` joints.
Result<void> storeZero(const std::filesystem::path& folder, const Address& address, const Identity& identity,
                       const JointArray& offset, size_t count);

/// [main] and I/O thread. Reads the zero offsets. `known` of the result is false if the arm was never calibrated, or if
/// it was plugged in again since then.
Zero loadZero(const std::filesystem::path& folder, const Address& address, const Identity& identity, size_t count);

}  // namespace hapticd::wire_arm
