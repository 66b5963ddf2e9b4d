// SPDX-License-Identifier: MIT
/// What can keep real time or a device from working, each as one check with the command that fixes it.
#pragma once
#include <string>
#include <vector>

#include "host/catalog.hpp"

namespace hapticd::diagnostics {

enum class Verdict { kOk, kWarn, kFail };

struct Finding {
  std::string name;  ///< "scheduler", stable, because tools read it
  Verdict verdict = Verdict::kOk;
  std::string state;        ///< what was measured
  std::string consequence;  ///< empty when ok
  std::string fix;          ///< a command or an action; empty if all is well
};

/// [main] Every check except the latency run, quick and without side effects.
std::vector<Finding> checkSystem(host::Catalog& catalog);

/// [main] Wakes up at 1 kHz for `seconds` as the servo would, and judges how late it is.
Finding checkLatency(double seconds);

}  // namespace hapticd::diagnostics
