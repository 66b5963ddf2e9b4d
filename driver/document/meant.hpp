// SPDX-License-Identifier: MIT
/// What a person meant who wrote a value that cannot be read: how to mend it, for the end of a message.
#pragma once
#include <string>
#include <string_view>

#include "document/node.hpp"

namespace hapticd::document {

/// [any] "; write 0.04: 40 mm are 0.04 m" for a text in the place of a number, or "" if it cannot be guessed: decimal
/// commas, units, quotes, blanks or signs between digits, formulas.
/// @param unit that is expected; "": not known
std::string numberMeant(std::string_view text, std::string_view unit = "");

/// [any] "; write [0, 0, 0.1]" for a node in the place of a list of numbers, or "".
std::string listMeant(const Node& node, size_t count);

/// [any] "; write rate: 1000" for a node in the place of a mapping, or "".
std::string mappingMeant(const Node& node);

/// [any] " (no blank after the colon, expected \"rate: 1000\")" for an unknown key that holds its own value, quotes of
/// print, or a blank that is none; or "".
std::string keyMeant(std::string_view key);

/// [any] "; ~ is not read as a folder ..." for a path as a shell knows it, or "".
std::string pathMeant(std::string_view path);

}  // namespace hapticd::document
