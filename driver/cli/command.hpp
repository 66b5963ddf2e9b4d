// SPDX-License-Identifier: MIT
/// What the subcommands share: exit codes, messages, loading a scene.
///
/// A subcommand is a file of its own with a function `void addNAME(const Command& app, int& exit_code)`, listed in
/// commands.hpp.
#pragma once
#include <cstdio>
#include <optional>
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

/// [main] Why a picture, which is always SVG, cannot have this name; "": it can.
std::string wrongPicture(const std::string& file);

/// Prints "error: MESSAGE" and gives back the exit code.
int fail(int exit_code, const std::string& message);

/// Messages of plugins and modules, one per line, on standard error.
void logToTerminal(int level, const std::string& who, const std::string& text);

/// While an object of this type lives, errors of plugins and modules wait. A set-up that fails because of them reports
/// them in its own message, so that they are reported once.
class SetupErrors {
 public:
  SetupErrors();
  ~SetupErrors() { tell(); }
  SetupErrors(const SetupErrors&) = delete;
  SetupErrors& operator=(const SetupErrors&) = delete;
  /// [any] True if this message is an error, which waits from now on.
  static bool keeps(int level, const std::string& who, const std::string& text);
  /// [main] Reports what waits, and lets nothing wait any more.
  static void tell();
};

/// The options --config and --plugin-path, which stand before the subcommand.
void addGlobalOptions(const Command& app);

/// The daemon file of this machine; a file with problems ends the program with exit code 2.
const scene::Daemon& daemonSettings();

/// Plugins and modules, found with the search path of options, daemon file and environment.
host::Catalog& catalog();

/// Prints every problem as file:line:column: key: what is wrong, and what was expected.
void printProblems(const document::Problems& problems, std::FILE* out);

/// Prints warnings in the same way.
void printWarnings(document::Problems warnings, std::FILE* out);

/// Loads a scene, or prints every problem on standard error.
/// @param device_file replaces the scene's devices; empty: as the scene says
/// @param default_device takes the simulated arm if the scene names none; without it, devices may be empty
std::optional<scene::Scene> loadSceneOrReport(const std::string& file, const std::string& device_file = "",
                                              bool default_device = true);

}  // namespace hapticd::cli
