/// What the subcommands share: exit codes, messages, loading a scene.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace hapticd::cli {

constexpr int kWorked = 0;    ///< exit code: worked
constexpr int kFailed = 1;    ///< exit code: failed while running
constexpr int kBadInput = 2;  ///< exit code: bad input or usage

/// Prints "error: MESSAGE" and gives back the exit code.
int fail(int exit_code, const std::string& message);

/// Messages of plugins and modules, one a line, on standard error.
void logToTerminal(int level, const std::string& who, const std::string& text);

/// Loads a scene, or prints every problem as file:line:column: key: what, expected what.
/// @param device_file replaces the scene's devices; empty: as the scene says
std::optional<scene::Scene> loadSceneOrReport(const std::string& file, const std::string& device_file = "");

/// Subcommands, a file each. The callback of the chosen one sets the exit code.
void addCheck(CLI::App& app, int& exit_code);
void addDevice(CLI::App& app, int& exit_code);
void addDoctor(CLI::App& app, int& exit_code);
void addExplain(CLI::App& app, int& exit_code);
void addImport(CLI::App& app, int& exit_code);
void addPlugin(CLI::App& app, int& exit_code);
void addRun(CLI::App& app, int& exit_code);
void addTrace(CLI::App& app, int& exit_code);

}  // namespace hapticd::cli
