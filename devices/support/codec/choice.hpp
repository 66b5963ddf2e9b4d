// SPDX-License-Identifier: MIT
/// Reads a word of a file that must be one of several names.
#pragma once
#include <string>
#include <vector>

#include "codec/tree.hpp"
#include "document/suggestion.hpp"

namespace hapticd::codec {

template <class T>
struct Name {
  const char* name;
  T value;
};

/// [main] Returns the value whose name the file gives. For another word it notes a problem in the tree and returns the
/// first value. @param fits returns true for values that the problem's text should offer
template <class T, size_t N, class Fits>
T choiceOf(const Tree& tree, const Name<T> (&names)[N], const Fits& fits) {
  const size_t before = tree.problems();
  const std::string text = tree.text();
  std::string all;
  std::vector<std::string> known;
  for (const Name<T>& name : names) {
    if (text == name.name) return name.value;
    if (!fits(name.value)) continue;
    known.emplace_back(name.name);
    all += (all.empty() ? "" : ", ") + std::string(name.name);
  }
  if (tree.exists() && tree.problems() == before)
    tree.fail("\"" + text + "\", expected one of " + all + document::suggestion(text, known));
  return names[0].value;
}

template <class T, size_t N>
T choiceOf(const Tree& tree, const Name<T> (&names)[N]) {
  return choiceOf(tree, names, [](const T&) { return true; });
}

}  // namespace hapticd::codec
