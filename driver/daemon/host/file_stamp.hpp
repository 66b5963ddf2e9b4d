// SPDX-License-Identifier: MIT
/// Whether a file is still the one that was read.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace hapticd::host {

/// Changes when a file is written or replaced: device, inode, size, time of the last change in s and ns.
using FileStamp = std::array<int64_t, 5>;

/// [main] Nothing if there is no such file.
std::optional<FileStamp> stampOf(const std::filesystem::path& file);

/// One line that differs for another build of a file: its size, the time of its last change, and its real path.
std::string identityText(const std::filesystem::path& real, const std::optional<FileStamp>& stamp);

/// [main] The line of a file as it is on the disk.
std::string identityOnDisk(const std::filesystem::path& file);
/// [main] The line of a file as its code was loaded, whatever it has become since; "" if it was not loaded.
std::string identityLoaded(const std::filesystem::path& file);

}  // namespace hapticd::host
