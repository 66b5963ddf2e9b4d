// SPDX-License-Identifier: MIT
/// Loads code into this process. loader_posix.cpp does it by dlopen(); platform_none.cpp refuses, for programs that
/// hold all their plugins.
#pragma once
#include <filesystem>

#include "base/result.hpp"

namespace hapticd::host {

/// [main] Loads a file completely; it is never unloaded. @return a handle for symbolOf(), or the loader's own reason
Result<void*> loadFile(const std::filesystem::path& file);

/// [main] The address of a symbol of a loaded file, or the loader's own reason.
Result<const void*> symbolOf(void* handle, const char* symbol);

}  // namespace hapticd::host
