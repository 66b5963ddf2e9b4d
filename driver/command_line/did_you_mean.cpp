// SPDX-License-Identifier: MIT
#include "command_line/did_you_mean.hpp"

#include "command_line/command_line.hpp"

namespace hapticd::command_line {
namespace {

Suggest& suggest() {
  static Suggest function;
  return function;
}

}  // namespace

void suggestBy(const Suggest& function) {
  suggest() = function;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& known) {
  return suggest() ? suggest()(word, known) : "";
}

}  // namespace hapticd::command_line
