// SPDX-License-Identifier: MIT
/// Recognises a library whose file was replaced after it was loaded. The code in memory is then older than the file.
#pragma once
#include <filesystem>

namespace hapticd::host {

/// [any] True if another file has replaced the one that this process loaded as `file`.
bool replacedSinceLoaded(const std::filesystem::path& file);

}  // namespace hapticd::host
