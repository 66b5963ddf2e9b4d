// SPDX-License-Identifier: MIT
/// Whether a recording has all that a replay needs.
#pragma once
#include <string>
#include <vector>

#include "record/layout.hpp"
#include "record/recording.hpp"
#include "session/replay/about.hpp"

namespace hapticd::servo {

/// [main] Returns what the recording lacks for a replay, or "". @param wanted the streams that this hapticd writes
std::string missingIn(const record::Recording& recording, const RecordedRun& run,
                      const std::vector<record::StreamSpec>& wanted);

}  // namespace hapticd::servo
