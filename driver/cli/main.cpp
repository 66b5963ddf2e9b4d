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
std::string unknownCommand(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return "";
  for (const CLI::App* command : app.get_subcommands(nullptr))
    if (command->get_name() == argv[1]) return "";
  return argv[1];
}

/// The same of the second word, where the first has subcommands of its own; @param parent set to that first.
std::string unknownUnder(const CLI::App& app, int argc, char** argv, const CLI::App*& parent) {
  if (argc < 3 || argv[2][0] == '-') return "";
  for (const CLI::App* command : app.get_subcommands(nullptr))
    if (command->get_name() == argv[1] && !command->get_subcommands(nullptr).empty()) parent = command;
  return parent == nullptr ? "" : unknownCommand(*parent, argc - 1, argv + 1);
}

std::vector<std::string> commandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): a table of commands that is wrong ends the program, and says so
int main(int argc, char** argv) {
  using namespace hapticd::cli;
  if (argc == 3 && argv[1] == std::string_view(hapticd::host::kDescribeForParent))
    hapticd::host::describeForParent(argv[2]);
  if (argc == 4 && argv[1] == std::string_view(hapticd::watch::kGuardArgument)) hapticd::watch::guardMain(argc, argv);
  CLI::App app{"hapticd: a real-time haptic servo daemon. It traces NURBS and medial-axis shapes and pushes back."};
  int exit_code = kWorked;
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("hapticd ") + HAPTICD_VERSION);
  app.footer(
      "Examples:\n  hapticd run config/scenes/teapot.yaml --for 10 --report report.json\n  hapticd check "
      "my-scene.yaml\n  hapticd plugin list\n\nExit codes: 0 success, 1 failure while running, 2 bad input or usage.");
  addGlobalOptions(app);
  app.fallthrough();  // an option of the program may stand after the subcommand too
  for (const auto add : kCommands) add(app, exit_code);
  if (const std::string word = unknownCommand(app, argc, argv); !word.empty())
    return fail(kBadInput, "there is no subcommand \"" + word + "\", expected one of " +
                               hapticd::document::listed(commandNames(app), 30) +
                               hapticd::document::suggestion(word, commandNames(app)));
  const CLI::App* parent = nullptr;
  if (const std::string word = unknownUnder(app, argc, argv, parent); !word.empty())
    return fail(kBadInput, std::string(argv[1]) + " has no subcommand \"" + word + "\", expected one of " +
                               hapticd::document::listed(commandNames(*parent), 30) +
                               hapticd::document::suggestion(word, commandNames(*parent)));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kWorked : kBadInput;
  } catch (const std::exception& error) {
    return fail(kFailed, error.what());
  }
  return exit_code;
}
