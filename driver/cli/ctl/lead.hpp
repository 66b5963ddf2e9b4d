// SPDX-License-Identifier: MIT
/// `hapticd ctl lead`: moves a model or the simulated hand by lines of text.
#pragma once
#include <string>

#include "command_line/command_line.hpp"

namespace hapticd::cli {

struct LeadOptions {
  std::string socket;  ///< control socket of the daemon
  std::string model;   ///< name of the model to lead; empty if a hand is led
  std::string hand;    ///< name of the device whose simulated hand is led; empty if a model is led
  double hold = 1;     ///< [s] how long the lead continues after the last line

  bool complete() const { return model.empty() != hand.empty(); }  ///< whether either a model or a hand is named
};

/// Adds the options and the help of `ctl lead`. They fill all of `options` but the socket.
void addLeadOptions(const command_line::Command& lead, LeadOptions& options);

/// [main] Leads with one target per line of standard input, until the input ends. @return an exit code
int leadByLines(const LeadOptions& options);

}  // namespace hapticd::cli
