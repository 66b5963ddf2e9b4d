// SPDX-License-Identifier: MIT
/// What is said of a recording that did not end in order, or has not ended yet.
#pragma once
#include <string>

#include "record/recording.hpp"

namespace hapticd::cli {

/// [main] A note on standard error where the end is open. @param doing what the command does with the rest: "drawing"
void noteOpenEnd(const std::string& file, const record::Recording& recording, const char* doing);

}  // namespace hapticd::cli
