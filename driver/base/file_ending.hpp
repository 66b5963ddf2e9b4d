// SPDX-License-Identifier: MIT
/// The ending of a file's name, which says what the file holds.
#pragma once
#include <cctype>
#include <filesystem>
#include <string>

namespace hapticd {

/// [any] Returns the ending in small letters, such as ".step", or "" if the name has none.
inline std::string endingOf(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

}  // namespace hapticd
