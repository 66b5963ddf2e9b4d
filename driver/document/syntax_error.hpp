// SPDX-License-Identifier: MIT
/// Finds out why a text is not YAML, and describes the mistake in plain words, with its place. The message of a parser
/// does not serve this purpose: a parser notices a mistake only later in the text, and describes it in the terms of its
/// grammar.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "document/problem.hpp"

namespace hapticd::document {

/// [any] Returns what is wrong with a text. @param place the place where the parser gave up
/// @param words the parser's message
Problem findSyntaxError(const std::string& text, const Place& place, const std::string& words);

/// [any] Returns everything that may be wrong, the likeliest first. The last one is the parser's own message in plain
/// words, at the place where it gave up.
std::vector<Problem> likelySyntaxErrors(const std::string& text, const Place& place, const std::string& words);

/// [any] Returns the text with an unknown alias (*name) replaced by the marked name that resembles it, so that the rest
/// of the file can be read; "" if the parser gave up for another reason.
std::string withCorrectedAlias(const std::string& text, const Place& place, const std::string& words);

/// [any] Returns a problem if the last text in quotes is never closed. The parser itself reports nothing then: it takes
/// the end of the file for the closing quote.
std::optional<Problem> findOpenQuote(const std::string& text, const Place& last_quoted);

}  // namespace hapticd::document
