// SPDX-License-Identifier: MIT
#include "document/problem.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <list>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

namespace hapticd::document {

std::string Problem::text() const {
  const std::string where =
      place.file + ":" + std::to_string(std::max(place.line, 1)) + ":" + std::to_string(std::max(place.column, 1));
  return where + ": " + (key.empty() ? "" : key + ": ") + what;
}

void report(Problems& problems, const Place& place, const std::string& key, const std::string& what, ProblemKind kind) {
  Problem problem;
  problem.place = place;
  problem.key = key;
  problem.what = what;
  problem.kind = kind;
  problems.push_back(problem);
}

void report(Problems& problems, const std::string& file, int line, int column, const std::string& key,
            const std::string& what) {
  Place place;
  place.file = file;
  place.line = line;
  place.column = column;
  report(problems, place, key, what);
}

void append(Problems& problems, Problems more) {
  problems.insert(problems.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::string textOf(const Problems& problems) {
  std::string all;
  for (const Problem& one : problems) all += (all.empty() ? "" : "\n") + one.text();
  return all;
}

namespace {

using Words = std::set<std::string, std::less<>>;

/// Returns the words of a text: keys, and texts that may be names.
Words wordsOf(const std::string& text) {
  Words words;
  std::string word;
  for (const char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_')
      word += c;
    else if (!word.empty())
      words.insert(std::exchange(word, ""));
  }
  return words;
}

/// Returns the name at the end of a key such as "models[2].parameters.limits[0]".
std::string nameOf(const std::string& key) {
  const std::string path = key.substr(0, key.find_last_not_of("[]0123456789") + 1);
  return path.substr(path.rfind('.') + 1);
}

/// Returns true if a problem may follow from the text that a syntax error left out.
bool mayFollow(const Problem& one, const Problem& error, const Words& unread) {
  if (!one.left_out.empty() || one.place.file != error.place.file || one.what.starts_with("not YAML")) return false;
  const bool unknown = one.what.starts_with("unknown ");
  if (unread.contains(nameOf(one.key)) && (!unknown || one.place.line == error.place.line))
    return one.what.starts_with("missing") || unknown || one.what.find("lacks the key") != std::string::npos ||
           one.place.line == 0;
  if (unknown) return false;  // its message lists all keys
  const Words named = wordsOf(one.what);
  return std::any_of(named.begin(), named.end(), [&unread](const std::string& word) { return unread.contains(word); });
}

}  // namespace

void dropFollowUps(Problems& problems) {
  for (const Problem& error : Problems(problems)) {
    if (error.left_out.empty()) continue;
    const Words unread = wordsOf(error.left_out);
    std::erase_if(problems, [&](const Problem& one) { return mayFollow(one, error, unread); });
  }
}

bool leavesOut(const Problems& problems, const std::string& file) {
  constexpr std::string_view kIndented = "(read on as if ";  // this leaves nothing out
  return std::any_of(problems.begin(), problems.end(), [&](const Problem& one) {
    return !one.left_out.empty() && one.place.file == file && one.what.find(kIndented) == std::string::npos;
  });
}

void sortByPlace(Problems& problems) {
  std::map<std::string, size_t> order;
  for (const Problem& problem : problems) order.emplace(problem.place.file, order.size());
  // std::list::sort needs no buffer, and keeps the order of problems at the same place.
  std::list<Problem> sorted(std::make_move_iterator(problems.begin()), std::make_move_iterator(problems.end()));
  sorted.sort([&](const Problem& a, const Problem& b) {
    return std::tuple(order[a.place.file], a.place.line, a.place.column) <
           std::tuple(order[b.place.file], b.place.line, b.place.column);
  });
  problems.assign(std::make_move_iterator(sorted.begin()), std::make_move_iterator(sorted.end()));
}

}  // namespace hapticd::document
