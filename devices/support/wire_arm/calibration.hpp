// SPDX-License-Identifier: MIT
/// Zero positions that outlive a process, for arms whose encoders count from where they were switched on. They hold as
/// long as the arm stays plugged in: another plugging-in or another boot of the machine makes them void.
#pragma once
#include <filesystem>

#include "wire_arm/link.hpp"

namespace hapticd::wire_arm {

/// [main] The folder $STATE_DIRECTORY, $XDG_STATE_HOME/hapticd or ~/.local/state/hapticd.
std::filesystem::path stateFolder();

/// [main] Writes the offsets of `count` joints.
Result<void> storeZero(const std::filesystem::path& folder, const Address& address, const Identity& identity,
                       const JointArray& offset, size_t count);

/// [main] and I/O thread. Nothing is known of an arm that was never calibrated, or was plugged in since.
Zero loadZero(const std::filesystem::path& folder, const Address& address, const Identity& identity, size_t count);

}  // namespace hapticd::wire_arm
