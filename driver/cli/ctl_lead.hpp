// SPDX-License-Identifier: MIT
/// `hapticd ctl lead`: moves a model or the simulated hand by lines of text.
#pragma once
#include <string>

namespace hapticd::cli {

struct LeadOptions {
  std::string socket;  ///< of the daemon
  std::string model;   ///< either a model
  std::string hand;    ///< or a device whose simulated hand is led
  double hold = 1;     ///< [s] how long the lead continues after the last line
};

/// [main] Leads by the lines of standard input until it ends. @return an exit code
int leadByLines(const LeadOptions& options);

}  // namespace hapticd::cli
