// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "document/repair.hpp"

namespace hapticd::document {
namespace {

/// Lists of mappings in the files of hapticd and in model files. Below another key, a deeper line has a wrong
/// indentation rather than no dash before it.
constexpr std::array<std::string_view, 5> kLists{"models", "devices", "fields", "surfaces", "edges"};

bool hasDash(const std::string& line) {
  return contentOf(line) > indentOf(line);
}

/// Returns the index of the last line with content before this one; nothing if there is none.
std::optional<size_t> lineBefore(const Lines& lines, size_t index) {
  while (index-- > 0)
    if (!isIdle(lines[index])) return index;
  return std::nullopt;
}

/// Returns the first key of an element with a dash, also if the element is written in braces.
std::string firstKeyOf(const std::string& line) {
  const size_t begin = std::min(line.find_first_not_of("{ ", contentOf(line)), line.size());
  return line.substr(begin, line.find_first_not_of(kKeyLetters, begin) - begin);
}

/// Returns true if a line can begin an element of a list. Then the elements above it begin with the same key. If there
/// are none, the key above it must be that of a list.
bool mayBeginElement(const Lines& lines, size_t index) {
  const size_t indent = indentOf(lines[index]);
  bool has_others = false;
  for (auto at = lineBefore(lines, index); at; at = lineBefore(lines, *at)) {
    const std::string& line = lines[*at];
    if (indentOf(line) == indent && hasDash(line)) {
      if (firstKeyOf(line) == firstWordOf(lines[index])) return true;
      has_others = true;
    } else if (indentOf(line) <= indent && line[endOf(line) - 1] == ':') {
      return !has_others && std::find(kLists.begin(), kLists.end(), firstWordOf(line)) != kLists.end();
    } else if (indentOf(line) < indent) {
      return false;
    }
  }
  return false;
}

/// Returns the text with a dash before this line. The lines of the element stand below its content then.
Repair dashed(const Lines& lines, size_t index, const std::string& key) {
  const size_t indent = indentOf(lines[index]);
  size_t next = index + 1;
  while (next < lines.size() && isIdle(lines[next])) ++next;
  const bool below = next < lines.size() && indentOf(lines[next]) > indent;  // they stand there already
  const size_t content = below ? std::max(indentOf(lines[next]), indent + 2) : indent + 2;
  const std::string text = lines[index].substr(indent, endOf(lines[index]) - indent);
  Repair repair{lines, static_cast<int>(index) + 1, "", "", ""};
  constexpr size_t kShown = 40;
  repair.what = "not YAML: no dash before \"" + key + "\", which begins an element of a list, expected \"- " +
                text.substr(0, kShown) + "\"";
  repair.column = static_cast<int>(indent) + 1;
  repair.lines[index] =
      std::string(indent, ' ') + "-" + std::string(content - indent - 1, ' ') + lines[index].substr(indent);
  for (size_t i = next; !below && i < lines.size(); ++i) {
    if (isIdle(lines[i])) continue;
    if (indentOf(lines[i]) < indent || (indentOf(lines[i]) == indent && hasDash(lines[i]))) break;
    repair.lines[i].insert(0, content - indent, ' ');
  }
  return repair;
}

/// Returns the text with a dash before a row in brackets, below elements of the same kind; nothing if it is none.
std::optional<Repair> dashedRow(const Lines& lines, size_t index) {
  const size_t indent = indentOf(lines[index]);
  const char bracket = lines[index][indent];
  if (bracket != '[' && bracket != '{') return std::nullopt;
  for (auto at = lineBefore(lines, index); at; at = lineBefore(lines, *at)) {
    const std::string& line = lines[*at];
    if (!hasDash(line) && indentOf(line) >= indent && line[indentOf(line)] == bracket)
      continue;  // without its dash, too
    if (!hasDash(line) || line[contentOf(line)] != bracket || indentOf(line) > indent) return std::nullopt;
    Repair repair{lines, static_cast<int>(index) + 1, "", "", ""};
    repair.what = std::string("not YAML: no dash before \"") + bracket +
                  "\", which begins an element of a list, expected \"- " + bracket + "...\"";
    repair.column = static_cast<int>(indent) + 1;
    repair.lines[index] = std::string(indentOf(line), ' ') + "- " + lines[index].substr(indent);
    return repair;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Repair> withDash(const Lines& lines, int number) {
  const size_t index = static_cast<size_t>(number) - 1;
  std::vector<Repair> found;
  for (const auto& at : {std::optional(index), lineBefore(lines, index)}) {
    if (!at || isIdle(lines[*at])) continue;
    if (auto row = dashedRow(lines, *at)) found.push_back(*std::move(row));
    const std::string key = firstWordOf(lines[*at]);
    const bool value = !key.empty() && lines[*at][endOf(lines[*at]) - 1] != ':';
    if (value && !hasDash(lines[*at]) && mayBeginElement(lines, *at)) found.push_back(dashed(lines, *at, key));
  }
  return found;
}

}  // namespace hapticd::document
