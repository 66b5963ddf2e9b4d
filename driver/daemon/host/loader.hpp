// SPDX-License-Identifier: MIT
/// Loads code into this process. loader_posix.cpp uses dlopen(). platform_none.cpp refuses to load anything: it is for
/// programs that contain all their plugins.
#pragma once
#include <filesystem>

#include "base/result.hpp"

namespace hapticd::host {

/// [main] Loads a file completely; it is never unloaded. @return a handle for symbolOf(), or the error of the system's
/// loader
Result<void*> loadFile(const std::filesystem::path& file);

/// [main] Returns the address of a symbol of a loaded file, or the error of the system's loader.
Result<const void*> symbolOf(void* handle, const char* symbol);

}  // namespace hapticd::host
