// SPDX-License-Identifier: MIT
#include "document/repair.hpp"

#include <algorithm>
#include <set>

namespace hapticd::document {
namespace {

/// Returns the columns at which a line could begin here: those of the lines above it and of their contents.
std::vector<size_t> openIndents(const Lines& lines, size_t index) {
  std::set<size_t> open{0};
  size_t least = std::string::npos;  // lines that are deeper than one between them and here are closed
  for (size_t i = index; i-- > 0 && least > 0;) {
    if (isIdle(lines[i]) || hasTab(lines[i])) continue;
    const size_t indent = indentOf(lines[i]), content = contentOf(lines[i]);
    const bool opens = least == std::string::npos && lines[i][endOf(lines[i]) - 1] == ':';
    if (opens) open.insert(content + 2);
    if (indent < least) open.insert({indent, content});
    least = std::min(least, indent);
  }
  return {open.begin(), open.end()};
}

}  // namespace

/// Returns the end of the message about the first line with a tab, which names the others.
static std::string alsoTabs(const std::vector<size_t>& tabbed) {
  constexpr size_t kShown = 10;
  std::string which = tabbed.size() > 2 ? "; tabs indent also the lines" : "; a tab indents also line";
  for (size_t i = 1; i < std::min(tabbed.size(), kShown); ++i)
    which += (i == 1 ? " " : ", ") + std::to_string(tabbed[i] + 1);
  return tabbed.size() > kShown ? which + ", ..." : which;
}

/// Counts the lines of a correction that stand exactly below the content of the line before them.
static long aligned(const Repair& repair, const std::vector<size_t>& tabbed) {
  return std::count_if(tabbed.begin(), tabbed.end(), [&repair](size_t index) {
    size_t before = index;
    while (before > 0 && isIdle(repair.lines[before - 1])) --before;
    return before > 0 && contentOf(repair.lines[before - 1]) == indentOf(repair.lines[index]);
  });
}

std::vector<Repair> withoutTabs(const Lines& lines) {
  std::vector<size_t> tabbed;
  bool all = true;  // every indented line has a tab, so that all widths mean the same
  for (size_t i = 0; i < lines.size(); ++i) {
    if (hasTab(lines[i])) tabbed.push_back(i);
    all = all && (isIdle(lines[i]) || indentOf(lines[i]) == 0 || hasTab(lines[i]));
  }
  if (tabbed.size() < 2) return {};
  const std::string which = alsoTabs(tabbed);
  std::vector<Repair> found;
  for (const size_t width : {size_t{2}, size_t{4}, size_t{8}}) {
    Repair repair{lines, static_cast<int>(tabbed[0]) + 1, "", which, ""};
    for (const size_t i : tabbed) {
      std::string& line = repair.lines[i];
      size_t column = 0;
      for (size_t at = 0; at < indentOf(line); ++at)
        column = line[at] == '\t' ? (column / width + 1) * width : column + 1;
      line = std::string(column, ' ') + line.substr(indentOf(line));
      if (!all) repair.unread += firstWordOf(line) + " ";
    }
    found.push_back(std::move(repair));
  }
  std::stable_sort(found.begin(), found.end(),
                   [&tabbed](const Repair& a, const Repair& b) { return aligned(a, tabbed) > aligned(b, tabbed); });
  return found;
}

std::vector<Repair> otherIndents(const Lines& lines, int number) {
  const size_t index = static_cast<size_t>(number) - 1, now = indentOf(lines[index]);
  const bool tabs = hasTab(lines[index]);
  std::vector<size_t> indents = openIndents(lines, index);
  const auto distance = [now, tabs](size_t indent) {  // the width of a tab is unknown: the deepest place is likely
    return tabs ? -static_cast<long>(indent) : std::labs(static_cast<long>(indent) - static_cast<long>(now));
  };
  std::stable_sort(indents.begin(), indents.end(), [&distance](size_t a, size_t b) {
    return distance(a) != distance(b) ? distance(a) < distance(b) : a > b;
  });
  std::vector<Repair> found;
  for (const size_t indent : indents) {
    if (indent == now && !tabs) continue;
    Repair repair{lines, number, "", " (read on as if it were indented by " + std::to_string(indent) + ")", ""};
    // a line with a value has no lines of its own below it
    const bool alone = tabs || isIdle(lines[index]) || lines[index][endOf(lines[index]) - 1] != ':';
    const size_t end = alone ? index + 1 : endOfBlock(lines, index);
    for (size_t i = index; i < end; ++i) {
      std::string& line = repair.lines[i];
      if (isIdle(line)) continue;
      const size_t deeper = indentOf(line) - now;
      line = std::string(indent + deeper, ' ') + line.substr(indentOf(line));
      repair.unread += firstWordOf(line) + " ";
    }
    found.push_back(std::move(repair));
  }
  return found;
}

Repair withoutLine(const Lines& lines, int number, bool and_below) {
  const size_t index = static_cast<size_t>(number) - 1, end = and_below ? endOfBlock(lines, index) : index + 1;
  Repair repair{lines, number, "", "", ""};
  for (size_t i = index; i < end; ++i) {
    repair.unread += lines[i].substr(0, lines[i].find(" #")) + "\n";
    repair.lines[i].clear();
  }
  repair.read_as = end == index + 1
                       ? " (read on without this line)"
                       : " (read on without the lines " + std::to_string(number) + " to " + std::to_string(end) + ")";
  return repair;
}

}  // namespace hapticd::document
