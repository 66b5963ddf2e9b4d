// SPDX-License-Identifier: MIT
/// What a process calls itself.
#pragma once
#include <sys/types.h>

#include <cstddef>
#include <string>

namespace hapticd::servo {

inline constexpr size_t kMostPrograms = 256;  ///< most names that are kept; when there are more, all are looked up anew

/// [any] The name of a process for people: that of its file, with the script behind it where an interpreter runs one.
/// Printable characters alone, 48 of them at most; "?" where the process cannot be looked at.
std::string programOf(pid_t pid);

}  // namespace hapticd::servo
