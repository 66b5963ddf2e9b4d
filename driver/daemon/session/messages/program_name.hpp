// SPDX-License-Identifier: MIT
/// The name of a process, for messages.
#pragma once
#include <sys/types.h>

#include <cstddef>
#include <string>

namespace hapticd::servo {

/// largest number of names that are kept; when it is exceeded, all names are forgotten
inline constexpr size_t kMostPrograms = 256;

/// [any] Returns the name of a process: the name of its file, followed by the script if it is an interpreter. The name
/// has at most 48 characters, all printable. Returns "?" if the process cannot be read.
std::string programOf(pid_t pid);

}  // namespace hapticd::servo
