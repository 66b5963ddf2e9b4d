// SPDX-License-Identifier: MIT
/// Collects what is wrong with the lines of a mesh file, so that a person can fix all of them at once.
#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"

namespace hapticd::importing {

/// Keeps the first messages and counts the others, because a damaged file may have millions of wrong lines.
class WrongLines {
 public:
  void add(std::size_t line, std::string message) {
    if (messages_.size() < kMost)
      messages_.emplace_back(line, std::move(message));
    else
      ++more_;
  }
  bool none() const { return messages_.empty(); }

  /// Returns all messages by line, each on a line of its own. @param name name of the file
  Error error(const std::string& name) {
    std::stable_sort(messages_.begin(), messages_.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string text;
    for (const auto& [line, message] : messages_) text += (text.empty() ? "" : "\n") + message;
    if (more_ > 0) text += "\n" + name + ": " + std::to_string(more_) + " more lines are wrong";
    return Error{text};
  }

 private:
  static constexpr std::size_t kMost = 20;
  std::vector<std::pair<std::size_t, std::string>> messages_;
  std::size_t more_ = 0;
};

}  // namespace hapticd::importing
