// SPDX-License-Identifier: MIT
/// The names that messages suggest for a word that is not known.
#pragma once
#include <string>
#include <vector>

namespace hapticd::command_line {

/// Returns a text such as " (did you mean \"run\"?)", as the function of suggestBy() gives it, or "".
std::string didYouMean(const std::string& word, const std::vector<std::string>& known);

}  // namespace hapticd::command_line
