// SPDX-License-Identifier: MIT
#include "document/repair.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <set>

#include "document/yaml_scan.hpp"

namespace hapticd::document {
namespace {

constexpr const char* kKeyLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";

size_t indentOf(const std::string& line) {
  const size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos ? line.size() : first;
}

/// Returns true for a line without content: empty, or only a comment.
bool isIdle(const std::string& line) {
  const size_t first = line.find_first_not_of(" \t\r");
  return first == std::string::npos || line[first] == '#';
}

/// Returns where the key or value of a line begins, behind its indentation and the dashes of lists.
size_t contentOf(const std::string& line) {
  size_t at = indentOf(line);
  while (at + 1 < line.size() && line[at] == '-' && line[at + 1] == ' ') {
    const size_t next = line.find_first_not_of(' ', at + 1);
    if (next == std::string::npos) break;
    at = next;
  }
  return at;
}

/// Returns where the content of a line ends, before blanks and a comment.
size_t endOf(const std::string& line) {
  const size_t comment = line.find(" #");
  const size_t last = line.find_last_not_of(" \t\r", comment);
  return last == std::string::npos ? 0 : last + 1;
}

/// Returns the word at the beginning of the content, such as a key; "" if there is none.
std::string wordOf(const std::string& line) {
  const size_t begin = contentOf(line), end = std::min(line.find_first_not_of(kKeyLetters, begin), line.size());
  const bool word = begin < end && std::isalpha(static_cast<unsigned char>(line[begin])) != 0;
  return word ? line.substr(begin, end - begin) : "";
}

/// Returns true if a tab is in the indentation of a line.
bool hasTab(const std::string& line) {
  return !isIdle(line) && line.find('\t') < indentOf(line);
}

/// Returns the number after the last line of the block that begins with this line: the deeper lines below it.
size_t endOfBlock(const Lines& lines, size_t index) {
  size_t end = index + 1;
  for (size_t i = end; i < lines.size(); ++i) {
    if (isIdle(lines[i])) continue;
    if (indentOf(lines[i]) <= indentOf(lines[index])) break;
    end = i + 1;
  }
  return end;
}

/// Collects corrections of one line.
class Corrector {
 public:
  Corrector(const Lines& lines, const Place& place)
      : lines_(lines), index_(static_cast<size_t>(place.line) - 1), line_(lines[index_]) {
    column_ = std::min(static_cast<size_t>(std::max(place.column, 1)) - 1, line_.size());
  }

  std::vector<Repair> all() {
    marks();
    blanks();
    quotes();
    escapes();
    brackets();
    commas();
    colons();
    texts();
    return std::move(found_);
  }

 private:
  void add(const std::string& line, const std::string& what = "") {
    if (line == line_) return;
    Repair repair{lines_, static_cast<int>(index_) + 1, what, "", ""};
    repair.lines[index_] = line;
    found_.push_back(std::move(repair));
  }
  std::string inserted(size_t at, const std::string& text) const { return std::string(line_).insert(at, text); }

  /// Corrects a comment of C, and a dash without a blank.
  void marks() {
    const size_t first = indentOf(line_);
    if (line_.compare(first, 2, "//") == 0) add(std::string(line_).replace(first, 2, "#"));
    if (first + 1 >= line_.size() || line_[first] != '-') return;
    if (std::isalpha(static_cast<unsigned char>(line_[first + 1])) == 0) return;
    add(inserted(first + 1, " "));
    if (found_.empty()) return;
    Repair below = found_.back();  // the lines below it stand below its content, which the blank moves
    for (size_t i = index_ + 1; i < endOfBlock(lines_, index_); ++i)
      if (!isIdle(lines_[i])) below.lines[i].insert(0, " ");
    found_.push_back(std::move(below));
  }

  /// Adds the blank after the colon of the key.
  void blanks() {
    const size_t colon = contentOf(line_) + wordOf(line_).size();
    if (colon > contentOf(line_) && colon + 1 < line_.size() && line_[colon] == ':' && line_[colon + 1] != ' ')
      add(inserted(colon + 1, " "));
  }

  /// Closes a quote, at the end of the line or before one of the next commas or brackets. Each correction is a copy of
  /// the text, so a line with thousands of commas must not have one for each.
  void quotes() {
    constexpr size_t kMost = 32;
    size_t open = column_;
    const auto is = [this](size_t at) { return at < line_.size() && (line_[at] == '"' || line_[at] == '\''); };
    if (const auto quote = scanYaml(line_).quote; quote && !is(open)) open = static_cast<size_t>(quote->column) - 1;
    if (!is(open)) return;
    const std::string quote(1, line_[open]);
    const size_t end = endOf(line_);
    size_t tried = 0;
    for (size_t at = line_.find_first_of(",]}", open); at < end && tried < kMost; ++tried) {
      add(inserted(at, quote));
      at = line_.find_first_of(",]}", at + 1);
    }
    if (end > open) add(inserted(end, quote));
  }

  /// Writes \ as \\ in a text in quotes, because it begins no escape sequence.
  void escapes() {
    std::string plain;
    for (const char c : line_) plain += c == '\\' ? std::string("\\\\") : std::string(1, c);
    if (line_.find('"') != std::string::npos) add(plain);
  }

  /// Adds, replaces or removes a bracket.
  void brackets() {
    if (column_ < line_.size() && (line_[column_] == ']' || line_[column_] == '}')) {
      const char other = line_[column_] == ']' ? '}' : ']';
      add(inserted(column_, std::string(1, other)));
      std::string line = line_;
      line[column_] = other;
      add(line);
      add(std::string(line_).erase(column_, 1));
    }
    std::string closing;
    const Scan scan = scanYaml(line_.substr(0, endOf(line_)));
    for (auto open = scan.open.rbegin(); open != scan.open.rend(); ++open) closing += open->what == '[' ? ']' : '}';
    if (!closing.empty()) add(inserted(endOf(line_), closing));
  }

  /// Adds commas between the entries of a list or mapping in brackets.
  void commas() {
    if (line_.find_first_of("[{") == std::string::npos) return;
    std::string line = line_;
    size_t last = endOf(line_);
    for (size_t at = line.find(' '); at < last; at = line.find(' ', at + 1)) {
      if (at == 0 || std::string(",[{:- ").find(line[at - 1]) != std::string::npos) continue;
      const size_t next = line.find_first_not_of(' ', at);
      if (next == std::string::npos) break;
      const size_t end = line.find_first_not_of(kKeyLetters, next);
      const bool key = end != std::string::npos && end > next && line.compare(end, 2, ": ") == 0;
      const bool list = (line[at - 1] == ']' || line[at - 1] == '}') && (line[next] == '[' || line[next] == '{');
      if (key || list) line.insert(at, ","), ++last;
    }
    add(line);
  }

  /// Adds the colon after a key.
  void colons() {
    const std::string key = wordOf(line_);
    const size_t begin = contentOf(line_), end = begin + key.size();
    if (key.empty() || end >= endOf(line_) || (line_[end] != ' ' && line_[end] != '=')) return;
    size_t value = line_.find_first_not_of(' ', end);
    if (line_[value] == '=') value = line_.find_first_not_of(' ', value + 1);
    if (value == std::string::npos || value >= endOf(line_)) return;
    const std::string meant = key + ": " + line_.substr(value, endOf(line_) - value);
    constexpr size_t kShown = 40;
    add(line_.substr(0, begin) + meant + line_.substr(endOf(line_)),
        "not YAML: no colon after \"" + key + "\", expected \"" + meant.substr(0, kShown) + "\"");
    if (!found_.empty()) found_.back().column = static_cast<int>(end) + 1;
  }

  /// Puts a text that YAML does not take as it is into quotes.
  void texts() {
    size_t begin = contentOf(line_);
    if (const size_t colon = line_.find(": ", begin); colon != std::string::npos)
      begin = line_.find_first_not_of(' ', colon + 1);
    if (begin == std::string::npos || begin >= endOf(line_) ||
        std::string("\"'[{|>&*").find(line_[begin]) != std::string::npos)
      return;
    std::string text;
    for (const char c : line_.substr(begin, endOf(line_) - begin)) text += c == '\'' ? "''" : std::string(1, c);
    add(line_.substr(0, begin) + "'" + text + "'" + line_.substr(endOf(line_)));
  }

  const Lines& lines_;
  size_t index_;
  const std::string& line_;
  size_t column_ = 0;
  std::vector<Repair> found_;
};

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

std::vector<Repair> corrections(const Lines& lines, const Place& place) {
  return Corrector(lines, place).all();
}

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
      if (!all) repair.unread += wordOf(line) + " ";
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
    const size_t end = tabs ? index + 1 : endOfBlock(lines, index);
    for (size_t i = index; i < end; ++i) {
      std::string& line = repair.lines[i];
      if (isIdle(line)) continue;
      const size_t deeper = indentOf(line) - now;
      line = std::string(indent + deeper, ' ') + line.substr(indentOf(line));
      repair.unread += wordOf(line) + " ";
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
