// SPDX-License-Identifier: MIT
#include "document/alike.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>
#include <vector>

namespace hapticd::document {
namespace {

/// Returns a key without the numbers of its items: models[].plugin for models[7].plugin; "" if it has none.
std::string withoutNumbers(const std::string& key) {
  std::string text;
  for (const char c : key)
    if (std::isdigit(static_cast<unsigned char>(c)) == 0 || !text.ends_with('[')) text += c;
  return text == key ? "" : text;
}

std::vector<std::string> splitAtBlanks(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

bool isName(const std::string& word) {
  return std::isalpha(static_cast<unsigned char>(word[0])) != 0 || word[0] == '\'' || word[0] == '"';
}

/// Returns whether two texts differ by one name alone, however often they have it.
bool sayTheSame(const std::string& one, const std::string& other) {
  const std::vector<std::string> a = splitAtBlanks(one), b = splitAtBlanks(other);
  if (a.size() != b.size()) return false;
  std::map<std::string, std::string> names;
  for (size_t i = 0; i < a.size(); ++i)
    if (a[i] != b[i] && (!isName(a[i]) || !isName(b[i]) || names.try_emplace(a[i], b[i]).first->second != b[i]))
      return false;
  return names.size() < 2;
}

}  // namespace

Problems withoutAlike(const Problems& problems) {
  constexpr size_t kMost = 3;
  std::vector<std::vector<size_t>> groups;
  for (size_t i = 0; i < problems.size(); ++i) {
    const std::string key = withoutNumbers(problems[i].key);
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const std::vector<size_t>& known) {
      const Problem& first = problems[known[0]];
      return !key.empty() && withoutNumbers(first.key) == key && first.place.file == problems[i].place.file &&
             sayTheSame(first.what, problems[i].what);
    });
    group != groups.end() ? group->push_back(i) : groups.push_back({i});
  }
  Problems once = problems;
  std::vector<bool> drop(problems.size(), false);
  for (const std::vector<size_t>& alike : groups) {
    if (alike.size() <= kMost) continue;
    for (size_t i = 1; i < alike.size(); ++i) drop[alike[i]] = true;
    once[alike[0]].what += " (and the same of " + std::to_string(alike.size() - 1) + " more, up to line " +
                           std::to_string(problems[alike.back()].place.line) + ")";
  }
  size_t at = 0;
  std::erase_if(once, [&](const Problem&) { return drop[at++]; });
  return once;
}

}  // namespace hapticd::document
