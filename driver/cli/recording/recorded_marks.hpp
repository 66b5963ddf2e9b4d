// SPDX-License-Identifier: MIT
/// The marks in a recording: moments that a program named during the run.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "record/recording.hpp"

namespace hapticd::cli {

/// [main] Returns the time [s] and the text of each mark. A text that no mark can have, in a damaged file, becomes "?".
std::vector<std::pair<double, std::string>> recordedMarks(const record::Recording& recording);

}  // namespace hapticd::cli
