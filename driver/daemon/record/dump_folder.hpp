// SPDX-License-Identifier: MIT
/// The folder for dumps of the black box. Dumps are named by their time, and only the newest are kept.
#pragma once
#include <cstddef>
#include <ctime>
#include <string>

namespace hapticd::record {

/// number of dumps that are kept, so that repeated faults do not fill a disk: 0.3 GB at 1 kHz
inline constexpr size_t kKeptDumps = 50;

/// [main] Creates the folder if it is missing, and removes all but the newest `kKeptDumps` - 1 dumps. Files with other
/// names, such as black boxes of crashes, are not removed. @return an unused file name for a dump of that time
std::string nextDump(const std::string& folder, std::time_t now);

}  // namespace hapticd::record
