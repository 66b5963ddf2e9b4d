// SPDX-License-Identifier: MIT
/// `hapticd`: one program, a subcommand a file.
#include <exception>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "cli/commands.hpp"
#include "document/suggestion.hpp"
#include "host/describe.hpp"
#include "watch/guard_process.hpp"

namespace {

/// The first word that is neither an option nor a subcommand, where a subcommand should stand; "" if there is none.
std::string unknownCommand(const hapticd::cli::Command& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return "";
  for (const auto& command : app.subcommands())
    if (command.name() == argv[1]) return "";
  return argv[1];
}

std::vector<std::string> commandNames(const hapticd::cli::Command& app) {
  std::vector<std::string> names;
  for (const auto& command : app.subcommands()) names.push_back(command.name());
  return names;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): a table of commands that is wrong ends the program, and says so
int main(int argc, char** argv) {
  using namespace hapticd::cli;
  if (argc == 3 && argv[1] == std::string_view(hapticd::host::kDescribeForParent))
    hapticd::host::describeForParent(argv[2]);
  if (argc == 4 && argv[1] == std::string_view(hapticd::watch::kGuardArgument)) hapticd::watch::guardMain(argc, argv);
  const hapticd::command_line::Program app(
      "hapticd: a real-time haptic servo daemon. It traces NURBS and medial-axis shapes and pushes back.");
  int exit_code = kWorked;
  app.requireSubcommand();
  app.version(std::string("hapticd ") + HAPTICD_VERSION);
  app.footer(
      "Examples:\n  hapticd run config/scenes/teapot.yaml --for 10 --report report.json\n  hapticd check "
      "my-scene.yaml\n  hapticd plugin list\n\nExit codes: 0 success, 1 failure while running, 2 bad input or usage.");
  addGlobalOptions(app);
  app.optionsMayFollowSubcommand();
  for (const auto add : kCommands) add(app, exit_code);
  if (const std::string word = unknownCommand(app, argc, argv); !word.empty())
    return fail(kBadInput, "there is no subcommand \"" + word + "\", expected one of " +
                               hapticd::document::listed(commandNames(app), 30) +
                               hapticd::document::suggestion(word, commandNames(app)));
  try {
    if (const auto ended = app.parse(argc, argv)) return *ended;
  } catch (const std::exception& error) {
    return fail(kFailed, error.what());
  }
  return exit_code;
}
