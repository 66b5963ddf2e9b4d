// SPDX-License-Identifier: MIT
/// `hapticd`: one program, with one file per subcommand.
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.hpp"
#include "cli/support/command.hpp"
#include "document/suggestion.hpp"
#include "host/describe.hpp"
#include "watch/guard_process.hpp"

namespace {

std::vector<std::string> commandNames(const hapticd::cli::Command& app) {
  std::vector<std::string> names;
  for (const auto& command : app.subcommands()) names.push_back(command.name());
  return names;
}

/// Returns what is wrong with the first word that should be a subcommand, at any depth, and is not one; "" if there is
/// none. A word after an option is not judged, because it may be the option's value.
std::string unknownCommand(const hapticd::cli::Command& app, int argc, char** argv, int at = 1) {
  const std::vector<std::string> names = commandNames(app);
  if (at >= argc || argv[at][0] == '-' || names.empty()) return "";
  for (const auto& command : app.subcommands())
    if (command.name() == argv[at]) return unknownCommand(command, argc, argv, at + 1);
  return std::string("there is no subcommand \"") + (at > 1 ? std::string(argv[at - 1]) + " " : "") + argv[at] +
         "\", expected one of " + hapticd::document::listedFor(argv[at], names, 30) +
         hapticd::document::suggestionOfName(argv[at], names);
}

/// Returns a message about the first option that no command of this line has; "" if there is none. The parser itself
/// would name the words after that option.
std::string unknownOption(const hapticd::cli::Command& app, int argc, char** argv) {
  std::vector<hapticd::cli::Command> path{app};
  std::string words = "hapticd";
  std::vector<std::string> names;
  const auto take = [&names](const hapticd::cli::Command& command) {
    for (const auto& option : command.options())
      for (const std::string& name : option.longNames()) names.push_back("--" + name);
  };
  take(app);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    for (const auto& command : path.back().subcommands())
      if (command.name() == word) {
        if (word == "client") return "";  // what follows belongs to another program
        take(command);
        path.push_back(command);
        words += " " + word;
        break;
      }
    const std::string name = word.substr(0, word.find('='));
    if (word.rfind("--", 0) != 0 || word == "--" || std::find(names.begin(), names.end(), name) != names.end())
      continue;
    return "there is no option " + name + hapticd::document::suggestionOfName(name, names) +
           (name == "--unit" ? "; --scale is metres per unit of the file: 0.001 for millimetres" : "") + "; see " +
           words + " --help";
  }
  return "";
}

/// Returns the exit code of the program. It is kFailed if a file that standard output was sent to is not complete. A
/// pipe is not judged, because its reader may end when it has read enough.
int codeOf(int code) {
  using namespace hapticd::cli;
  errno = 0;
  const bool whole = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  struct stat file{};
  const bool pipe = fstat(STDOUT_FILENO, &file) != 0 || S_ISFIFO(file.st_mode) || S_ISSOCK(file.st_mode);
  if (whole || pipe || code != kWorked) return code;
  return fail(kFailed, std::string("standard output cannot be written") +
                           (errno != 0 ? std::string(": ") + std::strerror(errno) : "") + "; it is not complete");
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): an exception from a wrong table of commands ends the program with a
// message
int main(int argc, char** argv) {
  using namespace hapticd::cli;
  if (argc == 3 && argv[1] == std::string_view(hapticd::host::kDescribeForParent))
    hapticd::host::describeForParent(argv[2]);
  if (argc == 4 && argv[1] == std::string_view(hapticd::watch::kGuardArgument)) hapticd::watch::guardMain(argc, argv);
  const hapticd::command_line::Program app(
      "hapticd: a real-time haptic servo daemon. It traces NURBS and medial-axis shapes, and a haptic arm "
      "gives the forces of their contacts to the hand.");
  int exit_code = kWorked;
  hapticd::command_line::suggestBy(hapticd::document::suggestion);
  app.requireSubcommand();
  app.version(std::string("hapticd ") + HAPTICD_VERSION);
  app.footer(
      "Examples:\n  hapticd run config/scenes/teapot.yaml --for 10 --report report.json\n  hapticd check "
      "my-scene.yaml\n  hapticd plugin list\n\nExit codes: 0 success, 1 failure while running, 2 bad input or usage.");
  addGlobalOptions(app);
  app.optionsMayFollowSubcommand();
  for (const auto add : kCommands) add(app, exit_code);
  if (const std::string wrong = unknownCommand(app, argc, argv); !wrong.empty()) return fail(kBadInput, wrong);
  if (const std::string wrong = unknownOption(app, argc, argv); !wrong.empty()) return fail(kBadInput, wrong);
  try {
    if (const auto ended = app.parse(argc, argv)) return codeOf(*ended);
  } catch (const BadDaemonFile& error) {
    return fail(kBadInput, error.what());
  } catch (const std::exception& error) {
    return fail(kFailed, error.what());
  }
  return codeOf(exit_code);
}
