// SPDX-License-Identifier: MIT
/// Asks the user of a command for the values that its options did not give.
#pragma once
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

#include "cli/support/command.hpp"
#include "document/node.hpp"

namespace hapticd::cli {

/// Reads a list such as 0.21, 0.17. @return false if a word of it is not a number
inline bool readNumbers(const std::string& text, std::vector<double>& numbers) {
  numbers.clear();
  for (const std::string& word : command_line::split(text, ',')) {
    const auto number = document::toNumber(command_line::trimmed(word));
    if (!number || !std::isfinite(*number)) return false;
    numbers.push_back(*number);
  }
  return true;
}

/// Asks the user for each value that no option gave. An empty answer keeps the present value.
class Questions {
 public:
  explicit Questions(const Command& command) : command_(command) {}

  /// Asks until the answer is accepted. @param wrong returns what is wrong with the answers so far, or ""
  template <class Value, class Wrong>
  void ask(const char* option, const char* question, Value& value, const Wrong& wrong) {
    if (command_.given(option)) return;
    for (const Value before = value;; value = before) {
      std::cout << question << " [" << before << "]: " << std::flush;
      std::string answer;
      if (!std::getline(std::cin, answer) || answer.empty()) return;
      const bool read = command_line::read(answer, value);
      const std::string what = read ? wrong() : "\"" + answer + "\" is not a number";
      if (what.empty()) return;
      std::cout << "  " << what << "\n";
    }
  }

  /// Asks for a list, such as 0.21, 0.17. An empty answer keeps the values of the template.
  template <class Wrong>
  void askList(const char* option, const std::string& question, std::vector<double>& list, const Wrong& wrong) {
    if (command_.given(option)) return;
    for (const std::vector<double> before = list;; list = before) {
      std::cout << question << ": " << std::flush;
      std::string answer;
      if (!std::getline(std::cin, answer) || answer.empty()) return;
      const std::string what = readNumbers(answer, list) ? wrong() : "\"" + answer + "\" is not a list of numbers";
      if (what.empty()) return;
      std::cout << "  " << what << "\n";
    }
  }

 private:
  const Command& command_;
};

}  // namespace hapticd::cli
