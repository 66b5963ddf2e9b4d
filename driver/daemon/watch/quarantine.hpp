// SPDX-License-Identifier: MIT
/// Plugins that crashed or hung the daemon, remembered from one start to the next until the user clears them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::watch {

struct QuarantinedPlugin {
  std::string plugin, reason;
};

/// [main] Folder of what outlives a run: STATE_DIRECTORY (as systemd gives it), XDG_STATE_HOME/hapticd or
/// ~/.local/state/hapticd; empty where none is named.
std::filesystem::path stateFolder();

/// [main] The same, created if it is missing; empty: there is none that can be written.
std::filesystem::path stateDir();

/// [main] The list, oldest first; a plugin stands in it once.
std::vector<QuarantinedPlugin> quarantined(const std::filesystem::path& dir);

/// [main] Takes a plugin off the list. False: it was not on it.
Result<bool> clearQuarantine(const std::filesystem::path& dir, const std::string& plugin);

/// The file under the state folder: one line per plugin: its name, a tab, the reason.
constexpr const char* kQuarantineFile = "quarantine";

}  // namespace hapticd::watch
