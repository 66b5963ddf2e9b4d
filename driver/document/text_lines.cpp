// SPDX-License-Identifier: MIT
#include "document/text_lines.hpp"

#include <algorithm>
#include <cctype>

namespace hapticd::document {

Lines linesOf(const std::string& text) {
  Lines lines;
  for (size_t start = 0; start <= text.size();) {
    const size_t end = std::min(text.find('\n', start), text.size());
    lines.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return lines;
}

std::string textOf(const Lines& lines) {
  std::string text;
  for (size_t i = 0; i < lines.size(); ++i) text += (i > 0 ? "\n" : "") + lines[i];
  return text;
}

size_t indentOf(const std::string& line) {
  const size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos ? line.size() : first;
}

bool isIdle(const std::string& line) {
  const size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#';
}

size_t contentOf(const std::string& line) {
  size_t at = indentOf(line);
  while (at + 1 < line.size() && line[at] == '-' && line[at + 1] == ' ') {
    const size_t next = line.find_first_not_of(' ', at + 1);
    if (next == std::string::npos) break;
    at = next;
  }
  return at;
}

size_t endOf(const std::string& line) {
  const size_t comment = line.find(" #");
  const size_t last = line.find_last_not_of(" \t\r", comment);
  return last == std::string::npos ? 0 : last + 1;
}

std::string firstWordOf(const std::string& line) {
  const size_t begin = contentOf(line), end = std::min(line.find_first_not_of(kKeyLetters, begin), line.size());
  const bool word = begin < end && std::isalpha(static_cast<unsigned char>(line[begin])) != 0;
  return word ? line.substr(begin, end - begin) : "";
}

bool hasTab(const std::string& line) {
  return !isIdle(line) && line.find('\t') < indentOf(line);
}

size_t endOfBlock(const Lines& lines, size_t index) {
  size_t end = index + 1;
  for (size_t i = end; i < lines.size(); ++i) {
    if (isIdle(lines[i])) continue;
    if (indentOf(lines[i]) <= indentOf(lines[index])) break;
    end = i + 1;
  }
  return end;
}

}  // namespace hapticd::document
