// SPDX-License-Identifier: MIT
/// The marks in a recording: moments that a program named during the run.
#pragma once
#include <string>
#include <vector>

#include "record/recording.hpp"

namespace hapticd::cli {

/// [main] Returns a line for each mark, such as "2.0010 s  trial 7 begins". A text that no mark can have, in a damaged
/// file, is shown as "?".
std::vector<std::string> recordedMarks(const record::Recording& recording);

}  // namespace hapticd::cli
