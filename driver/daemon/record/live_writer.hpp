// SPDX-License-Identifier: MIT
/// Whether somebody still writes a recording: its writer holds a lock on the file as long as it has it open, and the
/// kernel drops the lock however that process ends.
#pragma once
#include <optional>

namespace hapticd::record {

/// [main] The process that writes the file behind a descriptor; 0: there is one that cannot be seen from here; nothing:
/// nobody writes it.
std::optional<int> writerOf(int fd);

}  // namespace hapticd::record
