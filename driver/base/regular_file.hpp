// SPDX-License-Identifier: MIT
/// Reads and writes files that a user names. Pipes are refused, because a pipe without a writer would block the thread
/// for ever.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

#include "base/result.hpp"

namespace hapticd {

/// [any] Returns what is wrong with a file that is not regular, such as "is a pipe, expected a file"; "" if the file is
/// regular.
std::string notAFile(std::filesystem::file_type type);

/// [main] Opens a regular file for reading. The error is meant to follow the file's name in a message.
Result<int> openRegular(const std::string& file);

/// [main] Reads the bytes of a regular file. The errors are those of openRegular(), and a file of more than `max_bytes`
/// is an error too.
Result<std::string> readRegular(const std::string& file, size_t max_bytes);

/// [main] Removes a file whose writing failed, if it is regular: not a device, a pipe or a link.
void removeIncomplete(const std::string& file) noexcept;

/// [main] Writes a file completely or not at all. A device, a pipe or a link is written directly, so it may be left
/// incomplete. The error begins with the file's name.
Result<void> writeWhole(const std::string& file, const std::string& text);

}  // namespace hapticd
