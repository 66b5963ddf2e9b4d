// SPDX-License-Identifier: MIT
/// Checks the machine for problems with real time and with devices. Each finding gives the command that fixes the
/// problem.
#pragma once
#include <string>
#include <vector>

#include "host/catalog.hpp"

namespace hapticd::diagnostics {

enum class Verdict { kOk, kWarn, kFail };

struct Finding {
  std::string name;  ///< name such as "scheduler"; it never changes, because other programs read it
  Verdict verdict = Verdict::kOk;
  std::string state;        ///< what was measured
  std::string consequence;  ///< what a user notices; empty if all is well
  std::string fix;          ///< a command or an action; empty if all is well
};

/// Folders in which udev looks for rules. `cmake --install` puts ours below /usr/local.
inline constexpr const char* kUdevFolders[] = {"/etc/udev/rules.d", "/run/udev/rules.d", "/usr/local/lib/udev/rules.d",
                                               "/usr/lib/udev/rules.d", "/lib/udev/rules.d"};

/// [main] Makes every check except the latency run. All are quick and have no side effects.
std::vector<Finding> checkSystem(host::Catalog& catalog);

/// [main] Wakes up at 1 kHz for `seconds` as the servo would, and judges how late it is.
Finding checkLatency(double seconds);

}  // namespace hapticd::diagnostics
