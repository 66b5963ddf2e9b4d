// SPDX-License-Identifier: MIT
/// Asks a plugin or module file for its classes: in this process, in a child process, or in a separate program.
#pragma once
#include <filesystem>
#include <vector>

#include "base/result.hpp"
#include "description/class_info.hpp"

namespace hapticd::host {

/// [main] Returns the classes of a file that is a plugin, a module or both. The file is loaded in this process, so its
/// constructors run.
Result<std::vector<ClassInfo>> describe(const std::filesystem::path& file);

/// [main] Like describe(), but in a child process, so that a crash, hang or exit in a constructor becomes a message
/// about the file.
Result<std::vector<ClassInfo>> describeInChild(const std::filesystem::path& file);

/// [any] Like describe(), but in a separate program, for a process whose threads must not be disturbed by a fork.
/// @param program path of hapticd itself
Result<std::vector<ClassInfo>> describeByProgram(const std::filesystem::path& program,
                                                 const std::filesystem::path& file);

/// The first argument with which describeByProgram() starts hapticd; the second is the file.
constexpr const char* kDescribeForParent = "describe-for-parent";

/// [main] Describes the file to the parent that started hapticd by describeByProgram(), and ends the process.
[[noreturn]] void describeForParent(const std::filesystem::path& file);

}  // namespace hapticd::host
