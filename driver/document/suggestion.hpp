// SPDX-License-Identifier: MIT
/// Finds the known name that is nearest to a misspelt one, for "did you mean ...?".
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace hapticd::document {

/// [any] Returns the candidate nearest to `word`, or "" if none is near enough.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

/// [any] Returns a text such as " (did you mean \"stiffness\"?)", or "" if no candidate is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

/// [any] Returns "a, b, c", or "a, b, ... (17 in all)" if there are more than `most` names.
std::string listed(const std::vector<std::string>& names, size_t most = 12);

}  // namespace hapticd::document
