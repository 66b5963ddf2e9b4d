// SPDX-License-Identifier: MIT
/// The run of `hapticd-view`, from its options to its exit code.
#pragma once
#include <string>

namespace hapticd::view {

struct ServeOptions {
  std::string name = "hapticd";  ///< of the daemon
  std::string file;              ///< recording or dump to show instead of a daemon; empty for a daemon
  std::string drawings;          ///< socket of a process that draws the models of the recording
  unsigned short port = 0;       ///< 0 for any free port
  bool control = false;          ///< pages may change the run
  bool open = false;             ///< start a browser
  bool until_end = false;        ///< end with the daemon
};

/// [main] Prints the address of the page, and serves it until SIGINT, SIGTERM or the end of the daemon. Returns the
/// exit code; errors are on stderr.
int serve(const ServeOptions& options);

}  // namespace hapticd::view
