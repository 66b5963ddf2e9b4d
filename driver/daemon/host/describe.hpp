// SPDX-License-Identifier: MIT
/// Asks a plugin or module file what it holds: in this process, in a child, or by a program of its own.
#pragma once
#include <filesystem>
#include <vector>

#include "base/result.hpp"
#include "description/class_info.hpp"

namespace hapticd::host {

/// [main] The classes of a file that is a plugin, a module or both. Loads it in this process: constructors run.
Result<std::vector<ClassInfo>> describe(const std::filesystem::path& file);

/// [main] The same in a child process: a crash, a hang or an exit in a constructor becomes a message about that file.
Result<std::vector<ClassInfo>> describeInChild(const std::filesystem::path& file);

/// [any] The same by a program that is started for it: for a process whose threads must not feel a fork.
/// @param program hapticd itself
Result<std::vector<ClassInfo>> describeByProgram(const std::filesystem::path& program,
                                                 const std::filesystem::path& file);

/// The only argument but for the file when hapticd is started by describeByProgram().
constexpr const char* kDescribeForParent = "describe-for-parent";

/// [main] What hapticd does when it was started so. Ends the process.
[[noreturn]] void describeForParent(const std::filesystem::path& file);

}  // namespace hapticd::host
