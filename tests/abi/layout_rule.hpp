// SPDX-License-Identifier: MIT
/// The rule that keeps the ABI stable: lines of a struct never change and never move; new ones stand at its end.
#pragma once
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace hapticd::test {

/// A struct's name and its members, each "name offset size".
using Layout = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// Reads the text of a layout file: a struct's name stands at the margin, its members are indented.
inline Layout parseLayout(const std::string& text) {
  Layout layout;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] != ' ')
      layout.push_back({line, {}});
    else if (!layout.empty())
      layout.back().second.push_back(line.substr(line.find_first_not_of(' ')));
  }
  return layout;
}

/// Structs that must not grow either: they lie in arrays without a stride, inside other structs, or are written by a
/// side that cannot know how large the other side's is.
inline const std::set<std::string>& frozenStructs() {
  static const std::set<std::string> frozen = {"hsp_value", "hsp_change", "hsp_pose", "hsp_near",
                                               "hsp_entry", "hdv_sample", "hdv_entry"};
  return frozen;
}

/// Nothing, or the first thing of `now` that breaks programs built against `golden`.
inline std::string brokenPromise(const Layout& golden, const Layout& now) {
  for (const auto& [name, members] : golden) {
    const std::vector<std::string>* found = nullptr;
    for (const auto& [other, lines] : now)
      if (other == name) found = &lines;
    if (found == nullptr) return name + " is gone";
    for (size_t i = 0; i < members.size(); ++i) {
      if (i >= found->size()) return name + ": lost '" + members[i] + "'";
      if ((*found)[i] != members[i]) return name + ": was '" + members[i] + "', is '" + (*found)[i] + "'";
    }
    if (frozenStructs().count(name) != 0 && found->size() > members.size()) return name + " must not grow";
  }
  return "";
}

}  // namespace hapticd::test
