// SPDX-License-Identifier: MIT
/// Why a text is no YAML, where the slip of the hand is and in a person's words: a parser tells it late, and in its
/// own.
#pragma once
#include <optional>
#include <string>

#include "document/problem.hpp"

namespace hapticd::document {

/// [any] What is wrong with a text that the parser gave up at `place`, saying `words`.
Problem slipIn(const std::string& text, const Place& place, const std::string& words);

/// [any] The quote that is never closed, if the last text that was read began with it: then the parser takes the end of
/// the file for its end.
std::optional<Problem> openQuote(const std::string& text, const Place& last_quoted);

}  // namespace hapticd::document
