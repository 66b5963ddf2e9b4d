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
  std::string file;  ///< identity of the file that ended the run, see host::identityOnDisk; "": unknown

  /// A plugin of that name from that file is left out. A rebuilt one, and another file of the same name, are
  /// not.
  bool holds(const std::string& name, const std::string& identity) const {
    return name == plugin && (file.empty() || file == identity);
  }
};

/// [main] Folder of what outlives a run: STATE_DIRECTORY (as systemd gives it), XDG_STATE_HOME/hapticd or
/// ~/.local/state/hapticd; empty where none is named.
std::filesystem::path stateFolder();

/// [main] The same, created if it is missing; empty if none can be written.
std::filesystem::path stateDir();

/// [main] The list, oldest first; a file stands in it once.
std::vector<QuarantinedPlugin> quarantined(const std::filesystem::path& dir);

/// [main] Takes every file of a plugin off the list. False: it was not on it.
Result<bool> clearQuarantine(const std::filesystem::path& dir, const std::string& plugin);

/// The file in the state folder has one line per file: the plugin's name, a tab, the reason, a tab, the file's
/// identity.
constexpr const char* kQuarantineFile = "quarantine";

}  // namespace hapticd::watch
