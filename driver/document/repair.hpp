// SPDX-License-Identifier: MIT
/// Corrects a line of a text that is not YAML to what its writer may have meant, or leaves it out, so that the
/// rest of the file can be read.
#pragma once
#include <string>
#include <vector>

#include "document/problem.hpp"
#include "document/text_lines.hpp"

namespace hapticd::document {

/// One method to read on after a syntax error.
struct Repair {
  Lines lines;       ///< the whole text with the correction; a line that is left out is empty
  int first = 0;     ///< line that was corrected, counted from 1
  std::string what;  ///< what is wrong with the line, if this method shows it better than the parser's message; or ""
  std::string read_as;  ///< end of the message that says how the file was read on; "" if the correction is certain
  std::string unread;   ///< text whose place or value is a guess, so that other problems may follow from it
  int column = 1;       ///< column of the mistake, if `what` is given
};

/// [any] Returns corrections of a line, the most probable one first. @param place where the mistake was noticed
std::vector<Repair> corrections(const Lines& lines, const Place& place);

/// [any] Returns the text with a dash before the line, or before the one above it, if it begins an element of a list.
std::vector<Repair> withDash(const Lines& lines, int number);

/// [any] Returns the line with other indentations, together with the deeper lines below it.
std::vector<Repair> otherIndents(const Lines& lines, int number);

/// [any] Returns the text with blanks in place of the tabs that indent lines, for several widths of a tab. Returns
/// nothing if no line is indented by tabs, or only one.
std::vector<Repair> withoutTabs(const Lines& lines);

/// [any] Leaves out the line, or the line and the deeper lines below it.
Repair withoutLine(const Lines& lines, int number, bool and_below);

}  // namespace hapticd::document
