// SPDX-License-Identifier: MIT
/// Guesses what a person meant with a value that cannot be read, and says how to write it, for the end of a message.
#pragma once
#include <string>
#include <string_view>

#include "document/node.hpp"

namespace hapticd::document {

/// [any] Returns advice such as "; write 0.04: 40 mm is 0.04 m" for a text in the place of a number; "" if nothing can
/// be guessed. It recognises decimal commas, units, quotes, blanks or signs between digits, and formulas.
/// @param unit the expected unit; "" if it is unknown
std::string suggestNumber(std::string_view text, std::string_view unit = "");

/// [any] Returns advice such as "; write [0, 0, 0.1]" for a node in the place of a list of numbers, or "".
std::string suggestList(const Node& node, size_t count);

/// [any] Returns advice such as "; write rate: 1000" for a node in the place of a mapping, or "".
std::string suggestMapping(const Node& node);

/// [any] Returns advice such as " (no blank after the colon, expected \"rate: 1000\")" for an unknown key that contains
/// its own value, typographic quotes, or a no-break space; otherwise "".
std::string suggestKey(std::string_view key);

/// [any] Returns advice such as "; ~ is not replaced here ..." for a path in the form of a shell or of Windows, or "".
std::string suggestPath(std::string_view path);

}  // namespace hapticd::document
