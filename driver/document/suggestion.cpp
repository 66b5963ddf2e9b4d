// SPDX-License-Identifier: MIT
#include "document/suggestion.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "base/nearest_word.hpp"
#include "document/correction.hpp"

namespace hapticd::document {

namespace {

/// Returns the candidates that begin with a word of at least four letters, as "a" or "a" or "b"; "" if there is none,
/// or if there are many.
std::string withBeginning(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr size_t kShortest = 4, kMost = 3;
  if (word.size() < kShortest) return "";
  std::set<std::string> all;
  for (const std::string& candidate : candidates)
    if (candidate.starts_with(word)) all.insert(candidate);
  if (all.size() > kMost) return "";
  std::string text;
  for (const std::string& one : all) text += (text.empty() ? "" : " or ") + ('"' + one + '"');
  return text;
}

/// Returns the words of a name that "_" separates, in alphabetical order.
std::vector<std::string> partsOf(std::string_view name) {
  std::vector<std::string> words(1);
  for (const char letter : name) {
    if (letter == '_')
      words.emplace_back();
    else
      words.back() += letter;
  }
  std::sort(words.begin(), words.end());
  return words;
}

/// Returns the candidate with the same words in another order; "" if there is none.
std::string withSameWords(std::string_view name, const std::vector<std::string>& candidates) {
  const std::vector<std::string> words = partsOf(name);
  const auto same = [&words](const std::string& candidate) { return partsOf(candidate) == words; };
  const auto found = std::find_if(candidates.begin(), candidates.end(), same);
  return words.size() > 1 && found != candidates.end() ? *found : "";
}

}  // namespace

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  const size_t point = word.rfind('.');
  const bool decimal = point != word.npos && point > 0 && std::isdigit(static_cast<unsigned char>(word[point - 1]));
  // The last part of a key such as "arm.kind". The point in "premium1.5" does not separate parts.
  const std::string_view own = decimal ? word : word.substr(point + 1);
  for (const std::string_view key : {word, own})
    if (const std::string slip = suggestKey(key); !slip.empty()) return slip;
  return suggestionOfName(word, candidates);
}

std::string suggestionOfName(std::string_view name, const std::vector<std::string>& candidates) {
  std::string meant = withSameWords(name, candidates);
  if (meant.empty()) meant = nearestWord(name, candidates);
  meant = meant.empty() ? withBeginning(name, candidates) : '"' + meant + '"';
  return meant.empty() ? "" : " (did you mean " + meant + "?)";
}

std::string listed(const std::vector<std::string>& names, size_t most) {
  std::string text;
  for (size_t i = 0; i < std::min(most, names.size()); ++i) text += (i > 0 ? ", " : "") + names[i];
  if (names.size() > most) text += ", ... (" + std::to_string(names.size()) + " in all)";
  return text;
}

std::string listedFor(std::string_view word, const std::vector<std::string>& names, size_t most) {
  if (names.size() <= most) return listed(names, most);
  constexpr size_t kShortest = 4;  // letters of a word that is looked for within others
  const auto distance = [word](const std::string& name) -> size_t {
    const bool within = word.size() >= kShortest && name.find(word) != name.npos;
    const bool around = name.size() >= kShortest && word.find(name) != word.npos;
    return within || around ? 0 : editDistance(word, name);
  };
  constexpr size_t kNearest = 4;  // the others keep their order, in which what belongs together is together
  std::vector<std::pair<size_t, size_t>> order;  // distance, place in the list
  for (size_t i = 0; i < names.size(); ++i) order.emplace_back(distance(names[i]), i);
  std::sort(order.begin(), order.end());
  const auto by_place = [](const auto& a, const auto& b) { return a.second < b.second; };
  std::sort(order.begin() + static_cast<std::ptrdiff_t>(std::min(kNearest, order.size())), order.end(), by_place);
  std::vector<std::string> sorted;
  for (const auto& [away, place] : order) sorted.push_back(names[place]);
  return listed(sorted, most);
}

}  // namespace hapticd::document
