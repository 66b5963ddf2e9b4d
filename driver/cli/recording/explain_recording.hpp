// SPDX-License-Identifier: MIT
/// What `hapticd explain` prints of a recording.
#pragma once
#include <string>

namespace hapticd::cli {

/// [main] True if the file is a recording or a black box, judged by its first bytes.
bool isRecording(const std::string& file);

/// [main] Prints what a recording is of, and its events in words. Returns the exit code.
int explainRecording(const std::string& file);

}  // namespace hapticd::cli
