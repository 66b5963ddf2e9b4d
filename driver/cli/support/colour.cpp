// SPDX-License-Identifier: MIT
#include "cli/support/colour.hpp"

#include <unistd.h>

#include <cstdlib>

namespace hapticd::cli {

std::string coloured(const std::string& word, Colour colour) {
  static const bool kHas = [] {
    const char *no = std::getenv("NO_COLOR"), *term = std::getenv("TERM");  // https://no-color.org
    const bool dumb = term == nullptr || *term == '\0' || std::string(term) == "dumb";
    return isatty(STDOUT_FILENO) != 0 && !dumb && (no == nullptr || *no == '\0');
  }();
  if (!kHas) return word;
  const char* code = colour == Colour::kGood ? "32" : colour == Colour::kWarning ? "33" : "31";
  return std::string("\033[") + code + "m" + word + "\033[0m";
}

}  // namespace hapticd::cli
