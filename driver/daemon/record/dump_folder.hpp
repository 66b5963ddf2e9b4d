// SPDX-License-Identifier: MIT
/// Where dumps of the black box are kept: named by their time, the newest of them only.
#pragma once
#include <cstddef>
#include <ctime>
#include <string>

namespace hapticd::record {

inline constexpr size_t kKeptDumps = 50;  ///< 0.3 GB at 1 kHz, 2 GB at 10 kHz: faults that repeat must not fill a disk

/// [main] Makes the folder where it is missing, and room in it: dumps older than the newest `kKeptDumps` - 1 are
/// removed. Files with other names, such as black boxes of crashes, stay. @return a new name for a dump of that time,
/// not yet a file
std::string nextDump(const std::string& folder, std::time_t now);

}  // namespace hapticd::record
