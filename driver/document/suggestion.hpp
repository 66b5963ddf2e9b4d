// SPDX-License-Identifier: MIT
/// Texts about names: "did you mean ...?" for a misspelt one, and lists of the known ones.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace hapticd::document {

/// [any] Returns a text such as " (did you mean \"stiffness\"?)" for a key or a word of a document, or "" if no
/// candidate is near. Slips of writing that make odd keys are named, too, such as a decimal comma.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

/// [any] Returns the same for a name that was not part of a document, such as a word of a command.
std::string suggestionOfName(std::string_view name, const std::vector<std::string>& candidates);

/// [any] Returns "a, b, c", or "a, b, ... (17 in all)" if there are more than `most` names.
std::string listed(const std::vector<std::string>& names, size_t most = 12);

/// [any] Returns the same for names of which `word` is none. If there are more than `most`, the four that are
/// nearest to the word come first, so that the one that was meant is not left out.
std::string listedFor(std::string_view word, const std::vector<std::string>& names, size_t most = 12);

}  // namespace hapticd::document
