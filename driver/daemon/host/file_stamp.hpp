// SPDX-License-Identifier: MIT
/// Whether a file is still the one that was read.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace hapticd::host {

/// What changes when a file is written or replaced: device, inode, size, time of the last change in s and ns.
using FileStamp = std::array<int64_t, 5>;

/// [main] Nothing: there is no such file.
std::optional<FileStamp> stampOf(const std::filesystem::path& file);

}  // namespace hapticd::host
