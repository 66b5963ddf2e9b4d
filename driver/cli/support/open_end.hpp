// SPDX-License-Identifier: MIT
/// Notes about recordings that did not end in order, or that are still being written.
#pragma once
#include <string>

#include "record/recording.hpp"

namespace hapticd::cli {

/// [main] Prints a note on standard error if the recording has no proper end. @param doing what the command does with
/// the rows that exist, such as "drawing"
void noteOpenEnd(const std::string& file, const record::Recording& recording, const char* doing);

}  // namespace hapticd::cli
