// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>

#include "document/repair.hpp"
#include "document/yaml_scan.hpp"

namespace hapticd::document {
namespace {

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
    const size_t colon = contentOf(line_) + firstWordOf(line_).size();
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
    const std::string key = firstWordOf(line_);
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

}  // namespace

std::vector<Repair> corrections(const Lines& lines, const Place& place) {
  return Corrector(lines, place).all();
}

}  // namespace hapticd::document
