// SPDX-License-Identifier: MIT
/// Writes how many of something there are, for people.
#pragma once
#include <cstdint>
#include <string>

namespace hapticd {

/// [any] Returns a count with its noun: "1 report", "3 reports". @param many the words for any other count than 1; "":
/// `one` with an s
inline std::string counted(uint64_t count, const std::string& one, const std::string& many = "") {
  const std::string& words = count == 1 || many.empty() ? one : many;
  return std::to_string(count) + " " + words + (count != 1 && many.empty() ? "s" : "");
}

}  // namespace hapticd
