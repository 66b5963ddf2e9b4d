// SPDX-License-Identifier: MIT
/// "Did you mean ...?": the known names that a misspelt one is near to.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace hapticd::document {

/// [any] Edits (insert, delete, replace, swap of neighbours) between two words, ignoring case.
size_t editDistance(std::string_view a, std::string_view b);

/// [any] The candidate nearest to `word`, or "" if none is near enough to be the word that was meant.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// [any] " (did you mean \"stiffness\"?)", or "".
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

/// [any] "a, b, c", or "a, b, ... (17 in all)" where the list is long.
std::string listed(const std::vector<std::string>& names, size_t most = 12);

}  // namespace hapticd::document
