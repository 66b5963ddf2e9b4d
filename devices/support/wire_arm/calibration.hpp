// SPDX-License-Identifier: MIT
/// Stores zero positions in a file, for arms whose encoders count from the position in which they were switched on. A
/// stored zero is valid as long as the arm stays plugged in, and the machine is not booted again.
#pragma once
#include <filesystem>

#include "wire_arm/link.hpp"

namespace hapticd::wire_arm {

/// [main] Returns $STATE_DIRECTORY, $XDG_STATE_HOME/hapticd or ~/.local/state/hapticd: the first that is set.
std::filesystem::path stateFolder();

/// [main] Writes the zero offsets of `count` joints.
Result<void> storeZero(const std::filesystem::path& folder, const Address& address, const Identity& identity,
                       const JointArray& offset, size_t count);

/// [main] and I/O thread. Reads the zero offsets. `known` of the result is false if the arm was never calibrated, or if
/// it was plugged in again since then.
Zero loadZero(const std::filesystem::path& folder, const Address& address, const Identity& identity, size_t count);

}  // namespace hapticd::wire_arm
