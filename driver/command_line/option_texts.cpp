// SPDX-License-Identifier: MIT
#include "command_line/option_texts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "command_line/command_line.hpp"

namespace hapticd::command_line {
namespace {

bool isWhole(const OptionFacts& option) {
  return option.type.starts_with("INT") || option.type.starts_with("UINT");
}

bool isNumber(const OptionFacts& option) {
  return isWhole(option) || option.type.starts_with("FLOAT");
}

std::string upper(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::toupper(c); });
  return word;
}

/// Returns a text such as "--position: expected 3 numbers, got 2: 0.1 0".
std::string expectedCount(const OptionFacts& option) {
  constexpr int kMany = 1 << 16;  // CLI11 stands for "any number of values" with a large number
  std::string count = std::to_string(option.least);
  if (option.most >= kMany)
    count = "at least " + count;
  else if (option.most != option.least)
    count += " to " + std::to_string(option.most);
  std::string text = fmt::format("{}: expected {} {}{}, got ", option.name, count,
                                 isNumber(option) ? "number" : "value", option.most == 1 ? "" : "s");
  text += option.given.empty() ? "none" : fmt::format("{}: {}", option.given.size(), fmt::join(option.given, " "));
  const bool commas = std::any_of(option.given.begin(), option.given.end(),
                                  [](const std::string& word) { return word.find(',') != std::string::npos; });
  return text + (commas ? "; separate them by spaces" : "");
}

}  // namespace

std::string replaced(const std::string& text, std::string_view what, std::string_view with) {
  const size_t at = text.find(what);
  return at == std::string::npos ? text : text.substr(0, at) + std::string(with) + text.substr(at + what.size());
}

std::string readableType(const std::string& type) {
  const size_t colon = type.find(':');
  const std::string kind = type.substr(0, colon), rule = colon == std::string::npos ? "" : type.substr(colon + 1);
  std::string name = kind == "FLOAT" ? "NUMBER" : kind == "INT" || kind == "UINT" ? "INTEGER" : kind;
  if (rule.empty()) return name;
  return name == "TEXT" ? rule : name + " " + rule;
}

std::string unitOf(const std::string& description) {
  const size_t open = description.find('['), close = description.find(']', open);
  if (open == std::string::npos || close == std::string::npos) return "";
  return " " + description.substr(open + 1, close - open - 1);
}

std::string placeholders(const OptionFacts& option) {
  const auto words = split(trimmed(option.description.substr(0, option.description.find_first_of("[,;"))), ' ');
  const bool named = option.least > 1 && words.size() == static_cast<size_t>(option.least);
  if (named) return upper(fmt::format("{}", fmt::join(words, " ")));
  std::string value = isNumber(option) ? "NUMBER" : upper(option.name.substr(option.name.find_first_not_of('-')));
  std::string all = value;
  for (int i = 1; i < option.least; ++i) all += " " + value;
  return all;
}

std::string notWithin(const std::string& word, double low, double high, const std::string& unit) {
  double value = 0;
  if (!read(word, value))
    return fmt::format("\"{}\" is not a number, expected one from {:g} to {:g}{}", word, low, high, unit);
  if (value >= low && value <= high) return "";
  return fmt::format("{} is out of range, expected a number from {:g} to {:g}{}", word, low, high, unit);
}

std::string notWithin(const std::string& word, int low, int high, const std::string& unit) {
  int value = 0;
  if (!read(word, value))
    return fmt::format("\"{}\" is not a whole number, expected one from {} to {}{}", word, low, high, unit);
  if (value >= low && value <= high) return "";
  return fmt::format("{} is out of range, expected a whole number from {} to {}{}", word, low, high, unit);
}

std::string wrongCount(const OptionFacts& option, const std::string& told) {
  const size_t colon = told.find(": "), type = told.find(" required "), end = told.rfind(" missing");
  if (colon == std::string::npos || type == std::string::npos) return told;
  if (end != std::string::npos && option.least == 1) {
    const size_t from = type + std::string_view(" required ").size();
    const std::string count = told.substr(colon + 2, type - colon - 2), kind = told.substr(from, end - from);
    return fmt::format("{}: {} more value{} expected: {}", option.name, count, count == "1" ? "" : "s",
                       readableType(kind));
  }
  return expectedCount(option);
}

std::string splitAtDot(const OptionFacts& option) {
  const std::string word = option.given.empty() ? "" : option.given.front();
  const size_t dot = word.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == word.size()) return "";
  return "; did you mean \"" + word.substr(0, dot) + " " + word.substr(dot + 1) + "\"?";
}

std::string unreadable(const OptionFacts& option) {
  const std::string unit = unitOf(option.description), in = unit.empty() ? "" : " in" + unit;
  const char* const from = option.type.starts_with("UINT") ? " from 0" : "";
  double value = 0;
  for (const std::string& word : option.given) {
    if (!read(word, value))
      return fmt::format("{}: \"{}\" cannot be read, expected a {}number{}{}", option.name, word,
                         isWhole(option) ? "whole " : "", in, from);
    if (!isWhole(option)) continue;
    if (value != std::floor(value))
      return fmt::format("{}: \"{}\" is not a whole number, expected one{}{}", option.name, word, in, from);
    if (value < 0 && *from != '\0')
      return fmt::format("{}: {} is out of range, expected a whole number{}{}", option.name, word, in, from);
  }
  return fmt::format("{}: {} is out of range, expected a {}number nearer to 0{}", option.name,
                     fmt::join(option.given, " "), isWhole(option) ? "whole " : "", in);
}

}  // namespace hapticd::command_line
