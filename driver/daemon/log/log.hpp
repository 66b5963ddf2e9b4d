// SPDX-License-Identifier: MIT
/// The log of the process. Only ordinary threads write to it, because writing takes a lock and makes system calls.
/// Messages of the servo thread go into a ring, which an ordinary thread empties (host::Services).
#pragma once
#include <cstdint>
#include <string>

#include "base/result.hpp"

namespace hapticd::log {

/// Settings of the log. Levels are the numbers HSP_LOG_DEBUG to HSP_LOG_ERROR of the ABI.
struct Settings {
  int32_t level = 1;  ///< the lowest level that is written; 1: HSP_LOG_INFO
  std::string file;   ///< file for all messages, at most 10 MB; three older files are kept; "": no file
  bool json = false;  ///< true: one JSON object per line, {"time", "level", "who", "text"}
};

/// [main] Opens the log. Call it before other threads write messages. Without this call, messages of level info and
/// above go to stderr.
///
/// If stderr is a terminal, messages have the time of day and colours (unless NO_COLOR is set). For journald they have
/// the priorities of journald, and no time, because journald adds the time. Otherwise they have date and time. The call
/// fails if the file cannot be written.
Result<void> open(const Settings& settings);

/// [any ordinary thread] Writes a message. If that fails, the message is lost: a full disk must not end a run.
/// @param who the model, device or part that the message comes from; "" for the daemon itself
void write(int32_t level, const std::string& who, const std::string& text);

/// [main] Returns the level for a name: "debug", "info", "warning" or "error"; -1 for any other name.
int32_t levelOf(const std::string& name);

}  // namespace hapticd::log
