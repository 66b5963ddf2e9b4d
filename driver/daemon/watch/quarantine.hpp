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
  std::string file;  ///< identity of the file that ended the run, see host::identityOnDisk; "": not known

  /// A plugin of that name from that file stays out. One that was built anew, and another file of the same name, do
  /// not.
  bool holds(const std::string& name, const std::string& identity) const {
    return name == plugin && (file.empty() || file == identity);
  }
};

/// [main] Folder of what outlives a run: STATE_DIRECTORY (as systemd gives it), XDG_STATE_HOME/hapticd or
/// ~/.local/state/hapticd; empty where none is named.
std::filesystem::path stateFolder();

/// [main] The same, created if it is missing; empty: there is none that can be written.
std::filesystem::path stateDir();

/// [main] The list, oldest first; a file stands in it once.
std::vector<QuarantinedPlugin> quarantined(const std::filesystem::path& dir);

/// [main] Takes every file of a plugin off the list. False: it was not on it.
Result<bool> clearQuarantine(const std::filesystem::path& dir, const std::string& plugin);

/// The file under the state folder: one line per file: the plugin's name, a tab, the reason, a tab, the file's
/// identity.
constexpr const char* kQuarantineFile = "quarantine";

}  // namespace hapticd::watch
