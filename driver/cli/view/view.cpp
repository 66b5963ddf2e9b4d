// SPDX-License-Identifier: MIT
/// `hapticd view`: shows a running daemon, a recording, or a model at rest in a browser.
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/file_ending.hpp"
#include "base/os.hpp"
#include "cli/import/file_content.hpp"
#include "cli/recording/explain_recording.hpp"
#include "cli/recording/recorded_models.hpp"
#include "cli/run/view_process.hpp"
#include "cli/support/command.hpp"
#include "cli/view/still.hpp"
#include "control/liveness.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {

namespace {

struct ViewArguments {
  std::string name = "hapticd", file;
  int port = 0;
  double scale = 1;
  bool control = false, open = false;
};

std::vector<std::string> argumentsOf(const ViewArguments& options) {
  std::vector<std::string> arguments{"--name", options.name, "--port", std::to_string(options.port)};
  if (options.control) arguments.emplace_back("--control");
  if (options.open) arguments.emplace_back("--open");
  return arguments;
}

volatile sig_atomic_t viewer = 0;   ///< process id of the page's server, for the signal handler
volatile sig_atomic_t stopped = 0;  ///< the signal that ends this command; 0 if none came

void passToView(int signal) {
  stopped = signal;
  if (viewer > 0) kill(static_cast<pid_t>(viewer), signal);
}

/// Shows a recording: this process draws the models, another one serves the page.
int viewRecording(const ViewArguments& options) {
  os::onStopSignal(passToView);  // before the page has an address: who reads it may end this command at once
  auto models = RecordedModels::serve(options.file);
  if (!models) return fail(kBadInput, models.error());
  std::vector<std::string> arguments = argumentsOf(options);
  arguments.insert(arguments.end(), {"--file", options.file, "--drawings", (*models)->socket()});
  auto child = startView(arguments);
  if (!child) return fail(kFailed, child.error());
  viewer = *child;
  if (stopped != 0) kill(*child, stopped);  // it came before there was a child
  int status = 0;
  while (waitpid(*child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kFailed;
}

/// Shows a model or a scene that nobody runs.
int viewStill(const ViewArguments& options) {
  os::onStopSignal(passToView);  // the files of the models are removed also after a signal
  int exit_code = kWorked;
  const auto still = Still::of(options.file, options.scale, exit_code);
  if (!still) return exit_code;
  if (stopped != 0) return kWorked;
  std::fflush(stdout);  // what the import said, before the page is served
  std::fprintf(stderr, "%s is shown at rest; to feel it: %s\n", options.file.c_str(), still->command().c_str());
  ViewArguments shown = options;
  shown.file = still->recording();
  return viewRecording(shown);
}

/// Says that the page will wait, if no daemon of this name runs.
void tellOfWaiting(const ViewArguments& options) {
  const std::string socket = status::runtimeFolderOf(options.name) + "/" + options.name + ".sock";
  if (control::isAlive(socket)) return;
  std::fprintf(stderr,
               "no daemon named %s runs yet, so the page waits for it; %s\n  fix: start it with %s, or name another "
               "one with --name\n",
               options.name.c_str(), control::othersText(socket).c_str(), control::startText(socket).c_str());
}

/// True for a file that is there, and neither is a recording nor is called one.
bool isOther(const std::string& file) {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error) && endingOf(file) != ".h5" && !isRecording(file);
}

int refuse(const std::string& file) {
  if (const std::string other = misnamed(file); !other.empty()) return fail(kBadInput, other);
  return fail(kBadInput, file +
                             ": holds nothing that can be shown, expected a recording or dump (.h5), a part (.hpart), "
                             "a model file or scene (.yaml, .json), a medial mesh (.ma), CAD (.step, .iges, .brep), a "
                             "mesh (.obj, .stl, .ply) or patches (.bpt)");
}

int view(const ViewArguments& options) {
  if (Still::is(options.file)) return viewStill(options);
  if (isOther(options.file)) return refuse(options.file);
  if (!options.file.empty()) return viewRecording(options);
  tellOfWaiting(options);
  return fail(kFailed, becomeView(argumentsOf(options)).error());
}

}  // namespace

void addView(const Command& app, int& exit_code) {
  auto options = std::make_shared<ViewArguments>();
  const Command command =
      app.addSubcommand("view", "Show a running daemon, a recording, a part or a scene in a browser.");
  command.addOption("--name", options->name, "name of the daemon, as given to `hapticd run --name`; default: hapticd");
  command.addOption("--port", options->port, "port on 127.0.0.1; 0: a free one").wholeWithin(0, 65535);
  command.addFlag("--control", options->control, "allow the page to change the run and to lead a simulated hand");
  command.addFlag("--open", options->open, "open the page in your browser");
  command.addOption(
      "--file,recording", options->file,
      "show this file instead of a daemon: a recording or dump, or at rest a part, a model file, a scene, a "
      "CAD file, a mesh or Bezier patches");
  command
      .addOption(
          "--scale", options->scale,
          "CAD, mesh, patches: metres per unit of the file; CAD: a factor on top of the unit that the file states")
      .within(1e-9, 1e9);
  command.footer(
      "The command prints the address of the page with a token. Everybody who has the token may look.\nTo look from "
      "another computer, forward the port: ssh -L PORT:127.0.0.1:PORT HOST.\n\nExamples:\n  hapticd view --control "
      "--open\n  hapticd view run.h5 "
      "--open\n  hapticd view bracket.hpart --open");
  command.callback([options, &exit_code] { exit_code = view(*options); });
}

}  // namespace hapticd::cli
