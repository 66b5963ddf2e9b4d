// SPDX-License-Identifier: MIT
/// Asks a plugin or module file what it holds: in this process, in a child, or by a program of its own.
#pragma once
#include <filesystem>
#include <vector>

#include "base/result.hpp"
#include "description/class_info.hpp"

namespace hapticd::host {

/// [main] The classes of a file that is a plugin, a module or both. It is loaded in this process, so constructors run.
Result<std::vector<ClassInfo>> describe(const std::filesystem::path& file);

/// [main] The same in a child process: a crash, hang or exit in a constructor becomes a message about that file.
Result<std::vector<ClassInfo>> describeInChild(const std::filesystem::path& file);

/// [any] The same in a separate program, for a process whose threads must not be disturbed by a fork.
/// @param program hapticd itself
Result<std::vector<ClassInfo>> describeByProgram(const std::filesystem::path& program,
                                                 const std::filesystem::path& file);

/// The argument, besides the file, with which describeByProgram() starts hapticd.
constexpr const char* kDescribeForParent = "describe-for-parent";

/// [main] What hapticd does when it was started in that way. It ends the process.
[[noreturn]] void describeForParent(const std::filesystem::path& file);

}  // namespace hapticd::host
