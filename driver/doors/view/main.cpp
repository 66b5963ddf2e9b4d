// SPDX-License-Identifier: MIT
/// `hapticd-view`: shows a running daemon, or a recording, in a browser. It is a separate process, which only maps the
/// black box and talks to the control socket. It may be killed at any time. `hapticd view` starts it.
#include <cstdio>
#include <exception>

#include "command_line/command_line.hpp"
#include "serve.hpp"

int main(int argc, char** argv) {
  hapticd::view::ServeOptions options;
  const hapticd::command_line::Program app("hapticd-view: shows a running daemon, or a recording, in a browser.");
  app.addOption("--name", options.name, "name of the daemon");
  app.addOption("--port", options.port, "port on 127.0.0.1; 0 for any free port");
  app.addOption("--file", options.file, "show this recording or dump instead of a daemon");
  app.addOption("--drawings", options.drawings, "socket of a process that draws the models of the recording");
  app.addFlag("--control", options.control, "allow pages to change the run");
  app.addFlag("--open", options.open, "start a browser");
  app.addFlag("--until-end", options.until_end, "end with the daemon");
  try {
    if (const auto ended = app.parse(argc, argv)) return *ended;
    return hapticd::view::serve(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
