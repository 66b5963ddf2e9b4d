// SPDX-License-Identifier: MIT
/// Writes names in commands that people copy.
#pragma once
#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>

namespace hapticd {

/// [any] Returns a name as a shell takes it for one word: in single quotes if a character of it means something to a
/// shell, and with ./ before it if it would be taken for an option.
inline std::string shellWord(const std::string& name) {
  constexpr std::string_view kPlain = "_-./+,:@%=";
  const auto plain = [&](unsigned char c) {
    return std::isalnum(c) != 0 || c >= 0x80 || kPlain.find(static_cast<char>(c)) != std::string_view::npos;
  };
  std::string word = name.starts_with('-') ? "./" + name : name;
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace hapticd
