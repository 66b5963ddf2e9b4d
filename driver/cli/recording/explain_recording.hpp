// SPDX-License-Identifier: MIT
/// What `hapticd explain` prints of a recording.
#pragma once
#include <optional>
#include <string>

namespace hapticd::cli {

/// [main] True if the file is a recording or a black box, judged by its first bytes.
bool isRecording(const std::string& file);

/// [main] Prints what a recording is of, and its events in words. Returns the exit code.
/// @param at [s] only why the forces of this time are what they are
int explainRecording(const std::string& file, std::optional<double> at);

}  // namespace hapticd::cli
