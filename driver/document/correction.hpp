// SPDX-License-Identifier: MIT
/// Guesses what a person meant with a value that cannot be read, and says how to write it, for the end of a message.
#pragma once
#include <string>
#include <string_view>
#include <utility>

#include "document/node.hpp"

namespace hapticd::document {

/// [any] Returns advice such as "; write 0.04: 40 mm is 0.04 m" for a text in the place of a number; "" if nothing can
/// be guessed. It recognises decimal commas, units, quotes, blanks or signs between digits, and formulas.
/// @param unit the expected unit; "" if it is unknown
std::string suggestNumber(std::string_view text, std::string_view unit = "");

/// [any] Returns a message such as "\"800,5\" is not a number; write 800.5, with a point, not a comma" for a text that
/// is meant as a number but is none; "" for numbers and for words.
std::string wrongDecimal(const std::string& text);

/// A number that is out of its range because it is in another unit.
struct OtherUnit {
  std::string advice;  ///< such as "; 5 ms is 0.005 s"; "" if no unit is likely
  double meant = 0;    ///< the number in the expected unit
};

/// [any] Guesses that a number beyond its range is in millimetres, degrees, milliseconds, kilohertz or the like: the
/// number in the right unit is then in the range, and was a likely number to write.
OtherUnit suggestOtherUnit(double value, std::pair<double, double> allowed, std::string_view unit);

/// [any] Returns advice such as "; a comma separates two numbers: write 0.2, not 0,2" for a list with at least this
/// many zeros that are followed by whole numbers, or "".
std::string suggestDecimals(const Node& list, size_t least);

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
