// SPDX-License-Identifier: MIT
#include "document/recovery.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "document/syntax_error.hpp"

namespace hapticd::document {
namespace {

constexpr size_t kMostErrors = 30;        ///< corrections of one file
constexpr size_t kMostBytes = 64u << 10;  ///< longer texts are not corrected, because each attempt parses all of it
constexpr size_t kMostParsed = 4u << 20;  ///< bytes that are parsed for one file

/// An exception that ends the parsing of a text that is nested too deeply.
struct TooDeep {};

/// Takes the parser's events and keeps only the place of the last text in quotes.
class Silent final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string&) override {
    if (tag != "?" && !tag.empty()) last_quoted_ = mark;
  }
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    deeper();
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
    deeper();
  }
  void OnMapEnd() override { --depth_; }
  const YAML::Mark& lastQuoted() const { return last_quoted_; }

 private:
  void deeper() {
    if (++depth_ > kMaxDepth) throw TooDeep();
  }
  int depth_ = 0;
  YAML::Mark last_quoted_ = YAML::Mark::null_mark();
};

using LineColumn = std::pair<int, int>;
constexpr LineColumn kEnd{1 << 30, 0};  ///< beyond any text: it could be parsed

LineColumn placeOf(const YAML::Mark& mark) {
  return {std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

/// How far the parser comes, and its message.
struct Reached {
  LineColumn at = kEnd;
  std::string words{};

  bool operator==(const Reached&) const = default;
};

/// Returns where the parser gives up, or where a text in quotes begins that it took to the end; kEnd if all is well.
Reached parsedTo(const std::string& text) {
  Silent silent;
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Silent second;
    if (parser.HandleNextDocument(silent)) parser.HandleNextDocument(second);
  } catch (const YAML::Exception& error) {
    return {placeOf(error.mark), error.msg};
  } catch (const TooDeep&) {
    return {};  // this is no mistake of the syntax
  }
  const auto [line, column] = placeOf(silent.lastQuoted());
  if (findOpenQuote(text, {"", line, column})) return {{line, column}, ""};
  return {};
}

/// Returns the column in the file of a column of the corrected line. Between the parts at both ends of the line that
/// are equal, it is the first column that differs.
int columnIn(const std::string& given, const std::string& repaired, int column) {
  const size_t shorter = std::min(given.size(), repaired.size());
  size_t head = 0, tail = 0;
  while (head < shorter && given[head] == repaired[head]) ++head;
  while (tail < shorter - head && given[given.size() - 1 - tail] == repaired[repaired.size() - 1 - tail]) ++tail;
  const auto at = static_cast<size_t>(std::max(column, 1)) - 1;
  if (at < head) return column;
  if (at >= repaired.size() - tail) return column + static_cast<int>(given.size()) - static_cast<int>(repaired.size());
  return static_cast<int>(std::min(at, given.size() - tail)) + 1;
}

}  // namespace

Recovery::Recovery(const std::string& text, std::string file)
    : file_(std::move(file)), text_(text), given_(linesOf(text)), lines_(given_) {}

Place Recovery::inFile(Place place) const {
  const auto index = static_cast<size_t>(std::max(place.line, 1)) - 1;
  if (index < lines_.size() && lines_[index] != given_[index])
    place.column = columnIn(given_[index], lines_[index], place.column);
  return place;
}

void Recovery::toFile(Problems& problems) const {
  for (Problem& one : problems) one.place = inFile(one.place);
}

void Recovery::toFile(Node& node) const {
  node.column = inFile({file_, node.line, node.column}).column;
  for (Node& item : node.items) toFile(item);
  for (Entry& entry : node.entries) toFile(entry.key), toFile(entry.value);
}

void Recovery::use(Problem problem, const Repair& repair) {
  if (!repair.what.empty()) problem = {{file_, repair.first, repair.column}, "", repair.what};
  problem.what += repair.read_as;
  problem.left_out = repair.unread;
  problem.place = inFile(problem.place);
  // A line that was corrected before was corrected wrongly; its second error is none of the writer's.
  if (std::find(repaired_.begin(), repaired_.end(), repair.first) == repaired_.end())
    problems_.push_back(std::move(problem));
  else if (!problems_.empty())
    problems_.back().left_out += " " + problem.left_out;
  repaired_.push_back(repair.first);
  lines_ = repair.lines;
  text_ = textOf(lines_);
}

/// Returns the repair with which the parser comes farthest, at least beyond this line; of equal ones the first.
std::optional<Repair> Recovery::farthest(const std::vector<Repair>& repairs, const SyntaxError& error, int line) {
  const Reached gave_up{{error.place.line, error.place.column}, error.words};
  LineColumn most{line, std::numeric_limits<int>::max()};
  const Repair* best = nullptr;
  for (const Repair& one : repairs) {
    const std::string text = textOf(one.lines);
    parsed_ += text.size();
    if (parsed_ > kMostParsed || most == kEnd) break;
    const Reached reached = parsedTo(text);
    if (reached != gave_up && reached.at > most) best = &one, most = reached.at;
  }
  return best != nullptr ? std::optional(*best) : std::nullopt;
}

/// Finds a correction of the line at a place, or another indentation for it. It is left out instead if the parser then
/// comes farther.
std::optional<Repair> Recovery::corrected(const Place& place, const SyntaxError& error) {
  if (place.line < 1 || place.line > static_cast<int>(lines_.size())) return std::nullopt;
  std::vector<Repair> repairs = withDash(lines_, place.line);
  for (Repair& one : corrections(lines_, place)) repairs.push_back(std::move(one));
  if (const std::string meant = withCorrectedAlias(text_, error.place, error.words); !meant.empty())
    repairs.push_back({linesOf(meant), error.place.line, "", "", ""});
  for (const auto& more : {withoutTabs(lines_), otherIndents(lines_, place.line)})
    repairs.insert(repairs.end(), more.begin(), more.end());
  repairs.push_back(withoutLine(lines_, place.line, false));
  return farthest(repairs, error, place.line);
}

/// Leaves out a line and what stands below it, if that helps, or otherwise the line alone, for want of anything better.
std::optional<Repair> Recovery::leftOut(int line, const SyntaxError& error) {
  if (line < 1 || line > static_cast<int>(lines_.size())) return std::nullopt;
  if (auto block = farthest({withoutLine(lines_, line, true)}, error, line)) return block;
  const Repair alone = withoutLine(lines_, line, false);
  return alone.lines != lines_ && parsed_ <= kMostParsed ? std::optional(alone) : std::nullopt;
}

bool Recovery::recover(const SyntaxError& error) {
  const std::vector<Problem> likely =
      error.problem ? std::vector{*error.problem} : likelySyntaxErrors(text_, error.place, error.words);
  const bool may_repair = text_.size() <= kMostBytes && repaired_.size() < kMostErrors;
  const int before = error.place.line - 1;  // a line without a colon is noticed only at the next one
  if (may_repair && error.place.line >= 1 && error.place.line <= static_cast<int>(lines_.size()))
    if (const auto dash = farthest(withDash(lines_, error.place.line), error, error.place.line))
      return use(likely.front(), *dash), true;
  for (const Problem& one : likely) {
    if (!may_repair) break;
    if (&one == &likely.back() && before >= 1)
      if (const auto repair = farthest(corrections(lines_, {file_, before, 1}), error, error.place.line))
        return use(one, *repair), true;
    if (const auto repair = corrected(one.place, error)) return use(one, *repair), true;
  }
  for (const Problem& one : likely)
    if (const auto repair = may_repair ? leftOut(one.place.line, error) : std::nullopt) return use(one, *repair), true;
  problems_.push_back(likely.front());
  problems_.back().place = inFile(likely.front().place);
  return false;
}

}  // namespace hapticd::document
