// SPDX-License-Identifier: MIT
/// Finds out whether a file has changed since it was read.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace hapticd::host {

/// Numbers that change if a file is written or replaced: device, inode, size [bytes], and the time of the last change
/// in s and ns.
using FileStamp = std::array<int64_t, 5>;

/// [main] Returns the stamp of a file; nothing if there is no such file.
std::optional<FileStamp> stampOf(const std::filesystem::path& file);

/// Returns one line that identifies a build of a file: its size, the time of its last change, and its real path.
std::string identityText(const std::filesystem::path& real, const std::optional<FileStamp>& stamp);

/// [main] Returns the line of identityText() for a file as it is on the disk now.
std::string identityOnDisk(const std::filesystem::path& file);
/// [main] Returns the line of identityText() for a file as it was when its code was loaded; "" if it is not loaded.
std::string identityLoaded(const std::filesystem::path& file);

}  // namespace hapticd::host
