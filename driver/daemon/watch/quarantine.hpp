// SPDX-License-Identifier: MIT
/// The quarantine: plugins that ended the daemon by a crash or a hang. The list is kept from one start to the next,
/// until the user clears it.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::watch {

struct QuarantinedPlugin {
  std::string plugin, reason;
  std::string file;  ///< identity of the plugin's file (see host::identityOnDisk); "" if it is unknown

  /// True if a plugin of that name from that file must be left out. A rebuilt file, or another file with the same name,
  /// is not left out.
  bool holds(const std::string& name, const std::string& identity) const {
    return name == plugin && (file.empty() || file == identity);
  }

  /// Returns the file for people: its path, its size and when it was built; "" if it is unknown.
  std::string fileForPeople() const;
};

/// [main] Returns the folder for files that outlive a run: STATE_DIRECTORY (which systemd sets),
/// XDG_STATE_HOME/hapticd, or ~/.local/state/hapticd; empty if the environment names none of them.
std::filesystem::path stateFolder();

/// [main] Returns stateFolder(), and creates it if it is missing; empty if it cannot be written.
std::filesystem::path stateDir();

/// [main] Returns the list, oldest first, with each file once.
std::vector<QuarantinedPlugin> quarantined(const std::filesystem::path& dir);

/// [main] Removes every file of a plugin from the list. Returns false if the plugin was not on it.
Result<bool> clearQuarantine(const std::filesystem::path& dir, const std::string& plugin);

/// Name of the list's file in the state folder. Each of its lines has the plugin's name, a tab, the reason, a tab, and
/// the identity of the plugin's file.
constexpr const char* kQuarantineFile = "quarantine";

}  // namespace hapticd::watch
