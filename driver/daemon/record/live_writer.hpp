// SPDX-License-Identifier: MIT
/// Finds out whether a process is still writing a recording. The writer holds a lock on the file as long as the file is
/// open, and the kernel releases the lock even if the process is killed.
#pragma once
#include <optional>

namespace hapticd::record {

/// [main] Returns the id of the process that writes the file of a descriptor. Returns 0 if there is such a process but
/// its id cannot be found out, and nothing if there is none.
std::optional<int> writerOf(int fd);

}  // namespace hapticd::record
