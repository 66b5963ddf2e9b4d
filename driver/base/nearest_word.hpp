// SPDX-License-Identifier: MIT
/// Finds the known word that is nearest to a misspelt one.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace hapticd {

/// [any] Returns the number of edits (insert, delete, replace, swap of neighbours) between two words, ignoring case.
size_t editDistance(std::string_view a, std::string_view b);

/// [any] Returns the candidate nearest to `word`, or "" if none is near enough.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace hapticd
