// SPDX-License-Identifier: MIT
/// A library whose file was written anew: the code in memory is still that of the file from before.
#pragma once
#include <filesystem>

namespace hapticd::host {

/// [any] Another file has taken the place of the one that this process loaded as `file`.
bool replacedSinceLoaded(const std::filesystem::path& file);

}  // namespace hapticd::host
