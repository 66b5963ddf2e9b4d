// SPDX-License-Identifier: MIT
/// The lines of a YAML text that cannot be parsed: where their contents begin and end, and which lines belong together.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace hapticd::document {

using Lines = std::vector<std::string>;

inline constexpr const char* kKeyLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

Lines linesOf(const std::string& text);
std::string textOf(const Lines& lines);

/// [any] Returns the number of blanks and tabs at the beginning of a line.
size_t indentOf(const std::string& line);

/// [any] Returns true for a line without content: empty, or only a comment.
bool isIdle(const std::string& line);

/// [any] Returns where the key or value of a line begins, behind its indentation and the dashes of lists.
size_t contentOf(const std::string& line);

/// [any] Returns where the content of a line ends, before blanks and a comment.
size_t endOf(const std::string& line);

/// [any] Returns the word at the beginning of the content, such as a key; "" if there is none.
std::string firstWordOf(const std::string& line);

/// [any] Returns true if a tab is in the indentation of a line.
bool hasTab(const std::string& line);

/// [any] Returns the number after the last line of the block that begins with this line: the deeper lines below it.
size_t endOfBlock(const Lines& lines, size_t index);

}  // namespace hapticd::document
