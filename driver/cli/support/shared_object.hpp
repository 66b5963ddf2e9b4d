// SPDX-License-Identifier: MIT
/// Distinguishes the file of a plugin or module from other files.
#pragma once
#include <fstream>
#include <string>
#include <string_view>

namespace hapticd::cli {

/// [main] Returns true for a shared object, by its first bytes. For a scene that was given by mistake, the loader would
/// only say "invalid ELF header".
inline bool isSharedObject(const std::string& file) {
  constexpr std::string_view kMagic =
      "\x7f"
      "ELF";
  char first[kMagic.size()] = {};
  std::ifstream(file, std::ios::binary).read(first, sizeof first);
  return std::string_view(first, sizeof first) == kMagic;
}

}  // namespace hapticd::cli
