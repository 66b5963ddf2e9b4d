// SPDX-License-Identifier: MIT
/// The daemon's log. One for the process; written by ordinary threads only, since it locks and calls the system. What
/// the servo thread has to say reaches it through a ring that an ordinary thread empties (host::Services).
#pragma once
#include <cstdint>
#include <string>

#include "base/result.hpp"

namespace hapticd::log {

/// Levels are those of the ABI: HSP_LOG_DEBUG to HSP_LOG_ERROR.
struct Settings {
  int32_t level = 1;  ///< the lowest level that is written; 1: HSP_LOG_INFO
  std::string file;   ///< messages also go here, 10 MB at most, and three older files are kept; "": no file
  bool json = false;  ///< one JSON object per line, {"time", "level", "who", "text"}, instead of words
};

/// [main] Opens the log, before the first thread that writes. Without it the log goes to stderr at level info.
///
/// A terminal gets the time of day and colour (unless NO_COLOR is set); journald its own priorities, since it stamps
/// the time itself; everything else the date and time. It fails if the file cannot be written.
Result<void> open(const Settings& settings);

/// [any ordinary thread] Writes a message. Errors of writing are dropped: a full disk must not end a run.
/// @param who the model, device or part that speaks; "": the daemon itself
void write(int32_t level, const std::string& who, const std::string& text);

/// [main] The level of a name: "debug", "info", "warning", "error"; -1 for any other name.
int32_t levelOf(const std::string& name);

}  // namespace hapticd::log
