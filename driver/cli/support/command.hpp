// SPDX-License-Identifier: MIT
/// What the subcommands share: exit codes, messages, loading a scene.
///
/// A subcommand is a file of its own with a function `void addNAME(const Command& app, int& exit_code)`, listed in
/// commands.hpp.
#pragma once
#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "command_line/command_line.hpp"
#include "host/catalog.hpp"
#include "scene/load.hpp"

namespace hapticd::cli {

using command_line::Command;
using command_line::Option;

constexpr int kWorked = 0;                          ///< exit code: worked
constexpr int kFailed = 1;                          ///< exit code: failed while running
constexpr int kBadInput = command_line::kBadUsage;  ///< exit code: bad input or usage

/// [main] Returns why a picture cannot have this file name (pictures are always SVG), or "" if it can.
std::string wrongPicture(const std::string& file);

/// Prints "error: MESSAGE" and returns the exit code.
int fail(int exit_code, const std::string& message);

/// Prints JSON on standard output, for programs, and returns kWorked. Bytes that are not UTF-8 are replaced, because
/// texts may come from a plugin, an arm or a file's name.
int printJson(const nlohmann::ordered_json& json);

/// Prints a message of a plugin or module as one line on standard error.
void logToTerminal(int level, const std::string& who, const std::string& text);

/// While an object of this type lives, errors of plugins and modules are stored instead of printed. If the set-up fails
/// because of them, the message of the failure contains them, so that each error is reported once.
class SetupErrors {
 public:
  SetupErrors();
  ~SetupErrors() { print(); }
  SetupErrors(const SetupErrors&) = delete;
  SetupErrors& operator=(const SetupErrors&) = delete;
  /// [any] Stores this message and returns true, if it is an error and an object of this type lives.
  static bool holdsBack(int level, const std::string& who, const std::string& text);
  /// [main] Prints the kept errors; later ones are printed at once.
  static void print();
};

/// Adds the options --config and --plugin-path, which stand before the subcommand.
void addGlobalOptions(const Command& app);

/// The daemon file of this machine has problems, which are printed. It ends the program with exit code 2. It is thrown,
/// because a call of exit() would be taken for one of a plugin while a command is guarded.
class BadDaemonFile : public std::runtime_error {
 public:
  BadDaemonFile() : std::runtime_error("the daemon file has problems; see above") {}
};

/// Returns the daemon file of this machine. It throws BadDaemonFile if the file has problems.
const scene::Daemon& daemonSettings();

/// Applies the settings of the daemon file of this machine to a scene. They hold for every scene.
void applyDaemonFile(scene::Scene& scene);

/// Returns the plugins and modules in the search path, which comes from the options, the daemon file and the
/// environment.
host::Catalog& catalog();

/// Returns the path of a page of the guides, such as "devices.md".
std::string guide(const std::string& page);

/// Prints every problem as file:line:column: key: what is wrong, and what was expected.
void printProblems(const document::Problems& problems, std::FILE* out);

/// Prints every warning as file:line:column: key: warning: what is wrong.
void printWarnings(document::Problems warnings, std::FILE* out);

/// Loads a scene, or prints every problem on standard error.
/// @param device_file device file that replaces the scene's devices; empty to keep them
/// @param default_device used if the scene names no device: true adds the simulated arm, false leaves the list of
/// devices empty
std::optional<scene::Scene> loadSceneOrReport(const std::string& file, const std::string& device_file = "",
                                              bool default_device = true);

}  // namespace hapticd::cli
