// SPDX-License-Identifier: MIT
#include "document/syntax_error.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "base/nearest_word.hpp"
#include "document/yaml_scan.hpp"

namespace hapticd::document {
namespace {

/// A line of YAML's block style: its indentation, and the column where its content begins (4 in "- - a").
struct Line {
  int number = 0, indent = 0, inner = 0;
  bool opens = false;  ///< true if a deeper line may follow
};

/// Returns the lines up to `last` that are not empty. It leaves out flow style ({}, []) and block texts (|, >), whose
/// indentation cannot be wrong.
std::vector<Line> blockLines(const std::string& text, int last) {
  std::vector<Line> lines;
  std::istringstream in(text);
  int number = 0, brackets = 0;
  for (std::string line; number < last && std::getline(in, line);) {
    ++number;
    const bool inside = brackets > 0;
    if (const size_t comment = line.find(" #"); comment != std::string::npos) line.erase(comment);
    for (const char c : line) brackets += c == '[' || c == '{' ? 1 : c == ']' || c == '}' ? -1 : 0;
    line.erase(line.find_last_not_of(" \r") + 1);
    const size_t first = line.find_first_not_of(' ');
    if (inside || first == std::string::npos || line[first] == '#' || line[first] == '\t') continue;
    Line one{number, static_cast<int>(first), static_cast<int>(first), false};
    size_t at = first;
    while (at + 1 < line.size() && line[at] == '-' && line[at + 1] == ' ') at = line.find_first_not_of(' ', at + 1);
    one.inner = static_cast<int>(at);
    const char end = line.back();
    one.opens = end == ':' || end == '-' || end == '|' || end == '>' || brackets > 0;
    lines.push_back(one);
  }
  return lines;
}

/// Finds a dash of a list without a blank after it, as in "-name: ball".
std::optional<Problem> gluedDash(const std::string& line, size_t first, int number, const std::string& file) {
  const size_t colon = line.find(": ", first);
  if (line[first] != '-' || first + 1 >= line.size() ||
      std::isalpha(static_cast<unsigned char>(line[first + 1])) == 0 || colon == std::string::npos)
    return std::nullopt;
  return Problem{{file, number, static_cast<int>(first) + 2},
                 "",
                 "not YAML: no blank after the dash, expected \"- " + line.substr(first + 1, colon - first) + " ...\""};
}

/// Finds a tab used for indentation, or a key without a blank after its colon, in a line up to `last`. The parser
/// notices these only later, where the mapping does not continue.
std::optional<Problem> wrongBlank(const std::string& text, int last, const std::string& file) {
  constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  std::istringstream in(text);
  int number = 0;
  for (std::string line; number < last && std::getline(in, line);) {
    const size_t first = line.find_first_not_of(' ');
    ++number;
    if (first == std::string::npos || line[first] == '#') continue;
    if (line[first] == '\t' && line.find_first_not_of(" \t\r") != std::string::npos)
      return Problem{
          {file, number, static_cast<int>(first) + 1}, "", "not YAML: a tab indents this line, expected spaces"};
    if (line.compare(first, 2, "//") == 0)
      return Problem{{file, number, static_cast<int>(first) + 1}, "", "not YAML: // begins no comment, expected #"};
    if (auto dash = gluedDash(line, first, number, file)) return dash;
    const size_t key = line.find_first_not_of("- ", first), end = line.find_first_not_of(kLetters, key);
    if (key == std::string::npos || end == std::string::npos || end == key || line[end] != ':') continue;
    if (end + 1 >= line.size() || std::string(" \t\r/:").find(line[end + 1]) != std::string::npos) continue;
    if (std::isalpha(static_cast<unsigned char>(line[key])) == 0) continue;  // not a key but a time, such as 12:30
    if (const size_t comment = line.find(" #"); comment != std::string::npos) line.erase(comment);
    const std::string name = line.substr(key, end - key);
    return Problem{{file, number, static_cast<int>(end) + 2},
                   "",
                   "not YAML: no blank after the colon, expected \"" + name + ": " +
                       line.substr(end + 1, std::min<size_t>(line.find_last_not_of(" \r") - end, 20)) + "\""};
  }
  return std::nullopt;
}

/// Finds a line up to `last` whose indentation is wrong. The parser notices this mistake only later, and describes it
/// in its own terms.
std::optional<Problem> wrongIndent(const std::string& text, int last, const std::string& file) {
  const auto wrong = [&](const Line& line, const std::string& expected) {
    return Problem{{file, line.number, line.indent + 1},
                   "",
                   "not YAML: the line is indented by " + std::to_string(line.indent) + ", expected " + expected};
  };
  std::vector<int> open;
  bool may_go_deeper = true;
  for (const Line& line : blockLines(text, last)) {
    const bool deeper = open.empty() || line.indent > open.back();
    if (deeper && !may_go_deeper)
      return wrong(
          line,
          std::to_string(open.back()) +
              ": only a line that ends with a colon can have deeper lines below it, and the line before does not");
    std::string all;
    for (const int indent : open) all += (all.empty() ? "" : " or ") + std::to_string(indent);
    while (open.size() > 1 && open.back() > line.indent) open.pop_back();
    if (!deeper && open.back() != line.indent) return wrong(line, all + ", as the lines above it are");
    if (deeper) open.push_back(line.indent);
    if (line.inner > line.indent) open.push_back(line.inner);
    may_go_deeper = line.opens;
  }
  return std::nullopt;
}

Problem at(const Mark& mark, const std::string& file, const std::string& what) {
  return {{file, mark.line, mark.column}, "", "not YAML: " + what};
}

std::string closing(char open) {
  return open == '[' ? "]" : "}";
}

/// Finds a bracket, in a line up to `last`, that is open where the next line begins a key that is no deeper. Mistakes
/// in later lines do not hide it.
std::optional<Problem> openAtEnd(const std::string& text, int last, const std::string& file) {
  std::istringstream in(text);
  std::optional<Mark> open;
  size_t indent = 0;
  int number = 0;
  for (std::string line; number < last && std::getline(in, line);) {
    const size_t first = line.find_first_not_of(" \t\r");
    ++number;
    if (first == std::string::npos || line[first] == '#') continue;
    const size_t key = std::min(line.find_first_not_of(" -", first), line.size()), colon = line.find(':', key);
    const bool begins = colon != std::string::npos && std::isalpha(static_cast<unsigned char>(line[key])) != 0 &&
                        line.find_first_of(" ,[]{}\"'", key) >= colon;
    if (open && begins && first <= indent)
      return at(
          *open, file,
          std::string("the ") + open->what + " that begins here is never closed, expected " + closing(open->what));
    const Scan scan = scanYaml(line);
    open = scan.open.empty() ? std::nullopt : std::optional(scan.open.front());
    if (open) open->line = number;
    indent = first;
  }
  return std::nullopt;
}

/// Finds a quote or a bracket that is never closed, is closed by the wrong one, or is closed too late.
std::optional<Problem> wrongPair(const std::string& text, const std::string& file) {
  const Scan scan = scanYaml(text);
  const auto quoted = [](char what) { return std::string("the ") + what; };
  if (scan.quote) return at(*scan.quote, file, quoted(scan.quote->what) + " that begins here is never closed");
  if (scan.wrong_close && scan.wrong_open)
    return at(*scan.wrong_close, file,
              quoted(scan.wrong_close->what) + " comes while the " + scan.wrong_open->what + " of line " +
                  std::to_string(scan.wrong_open->line) + ", column " + std::to_string(scan.wrong_open->column) +
                  " is open, expected " + closing(scan.wrong_open->what) + " before it");
  if (scan.wrong_close)
    return at(*scan.wrong_close, file,
              quoted(scan.wrong_close->what) + " closes nothing; remove it, or add the bracket that it closes");
  if (scan.long_quote)
    return at(*scan.long_quote, file,
              quoted(scan.long_quote->what) + " that begins here is closed only in line " +
                  std::to_string(scan.long_quote_ends) + ", expected the closing quote in line " +
                  std::to_string(scan.long_quote->line));
  if (!scan.open.empty())
    return at(scan.open.front(), file,
              quoted(scan.open.front().what) + " that begins here is never closed, expected " +
                  closing(scan.open.front().what));
  return std::nullopt;
}

size_t offsetOf(const std::string& text, const Place& place) {
  size_t start = 0;
  for (int line = 1; line < place.line && start != std::string::npos; ++line) {
    start = text.find('\n', start);
    if (start != std::string::npos) ++start;
  }
  return std::min(start == std::string::npos ? text.size() : start + static_cast<size_t>(place.column) - 1,
                  text.size());
}

/// Returns the character at a place.
char charAt(const std::string& text, const Place& place) {
  const size_t offset = offsetOf(text, place);
  return offset < text.size() ? text[offset] : '\0';
}

/// Returns the name of the anchor or alias that begins at an offset.
std::string nameAt(const std::string& text, size_t offset) {
  return text.substr(offset, text.find_first_of(" \t\r\n,[]{}", offset) - offset);
}

/// The name after an asterisk, and the marked name before it that resembles it.
struct Alias {
  size_t begin = 0;
  std::string name, meant;
};

Alias aliasAt(const std::string& text, const Place& place) {
  const size_t star = std::min(text.find('*', offsetOf(text, place)), text.size() - 1);
  Alias alias{star + 1, nameAt(text, star + 1), ""};
  std::vector<std::string> marked;
  for (size_t at = text.find('&'); at < star; at = text.find('&', at + 1))
    if (std::string name = nameAt(text, at + 1); name != alias.name) marked.push_back(std::move(name));
  alias.meant = nearestWord(alias.name, marked);
  return alias;
}

/// Translates the parser's message into plain words.
std::string plainMessage(const std::string& text, const Place& place, const std::string& words) {
  const char here = charAt(text, place);
  const auto begins = [&words](const char* with) { return words.rfind(with, 0) == 0; };
  if (begins("unknown token") && here > ' ')
    return std::string("a text cannot begin with ") + here + ", expected it in quotes";
  if (begins("the referenced anchor")) {
    const Alias alias = aliasAt(text, place);
    return "a text that begins with * stands for one marked with & before, but there is no &" + alias.name +
           (alias.meant.empty() ? "; to write an ordinary text that begins with *, put it in quotes"
                                : " (did you mean *" + alias.meant + "?)");
  }
  if (begins("unknown escape character"))
    return "a \\ within \"...\" begins an escape sequence, and " + words.substr(words.find_last_of(' ') + 1) +
           " is not one; expected / in a path, or '...' around the text";
  if (begins("illegal map value"))
    return "a second colon in this line, expected quotes around a text with a colon, or a new line for the second key";
  if (begins("illegal flow end")) return "this closing bracket closes nothing, expected an opening bracket before it";
  if (begins("end of map flow") || begins("end of sequence flow"))
    return "no comma between this and what stands before it, expected {key: value, key: value} or [1, 2]";
  if (begins("end of map not found") || begins("end of sequence not found"))
    return "this line does not continue the lines before it, "
           "expected key: value, or - for a list, with their indentation";
  return words;
}

}  // namespace

std::optional<Problem> findOpenQuote(const std::string& text, const Place& last_quoted) {
  const std::optional<Mark> open = scanYaml(text).quote;
  if (!open || open->line != last_quoted.line || open->column != last_quoted.column) return std::nullopt;
  return at(*open, last_quoted.file,
            std::string("the ") + open->what + " that begins here is never closed, expected the closing one");
}

std::string withCorrectedAlias(const std::string& text, const Place& place, const std::string& words) {
  if (words.rfind("the referenced anchor", 0) != 0 || text.empty()) return "";
  const Alias alias = aliasAt(text, place);
  if (alias.meant.empty()) return "";
  return std::string(text).replace(alias.begin, alias.name.size(), alias.meant);
}

std::vector<Problem> likelySyntaxErrors(const std::string& text, const Place& place, const std::string& words) {
  std::vector<Problem> all;
  if (auto open = openAtEnd(text, place.line, place.file)) all.push_back(*std::move(open));
  if (auto blank = wrongBlank(text, place.line, place.file)) all.push_back(*std::move(blank));
  if (auto pair = wrongPair(text, place.file)) all.push_back(*std::move(pair));
  if (auto indent = wrongIndent(text, place.line, place.file)) all.push_back(*std::move(indent));
  all.push_back({place, "", "not YAML: " + plainMessage(text, place, words)});
  return all;
}

Problem findSyntaxError(const std::string& text, const Place& place, const std::string& words) {
  return likelySyntaxErrors(text, place, words).front();
}

}  // namespace hapticd::document
