// SPDX-License-Identifier: MIT
/// Texts about one option: what its values should have been, its unit, and the words that stand for its values.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace hapticd::command_line {

/// An option, and the words that the command line gave to it.
struct OptionFacts {
  std::string name;         ///< such as "--position"
  std::string type;         ///< such as "FLOAT", "UINT", "TEXT:FILE"
  std::string description;  ///< such as "x y z [m], world frame"
  int least = 1, most = 1;  ///< number of values
  std::vector<std::string> given;
};

/// Returns the text with the first `what` in it replaced.
std::string replaced(const std::string& text, std::string_view what, std::string_view with);

/// Returns the placeholder of a value that the help shows for a type of CLI11, such as "NUMBER (0.5 to 2)" for
/// "FLOAT:(0.5 to 2)", or "FILE" for "TEXT:FILE".
std::string readableType(const std::string& type);

/// Returns the unit that a description has in brackets, with a space before it, such as " Hz"; "" if it has none.
std::string unitOf(const std::string& description);

/// Returns the words that stand for the values in a usage, such as "X Y Z".
std::string placeholders(const OptionFacts& option);

/// Returns "" if the word is a number from `low` to `high`, or what is wrong with it. `unit` begins with a space.
std::string notWithin(const std::string& word, double low, double high, const std::string& unit);
std::string notWithin(const std::string& word, int low, int high, const std::string& unit);

/// Describes a number of values that is too small or too large. Gives CLI11's "--for: At least 3 required but received
/// 2" and "--for: 1 required FLOAT:(0 to 1) missing" the form of the other messages.
std::string wrongCount(const OptionFacts& option, const std::string& told);

/// Returns "; did you mean "ball stiffness"?" if the word given to this option is such as "ball.stiffness", or "". It
/// is for commands that want two words and got one.
std::string splitAtDot(const OptionFacts& option);

/// Describes the word that the option could not read. Only numbers are converted, so a number was expected.
std::string unreadable(const OptionFacts& option);

}  // namespace hapticd::command_line
