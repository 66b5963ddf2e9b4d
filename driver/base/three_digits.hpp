// SPDX-License-Identifier: MIT
/// Writes numbers for people.
#pragma once
#include <cstdio>
#include <cstdlib>
#include <string>

namespace hapticd {

/// [any] Returns a number with three significant digits: 6010, not 6.01e+03.
inline std::string threeDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  std::snprintf(text, sizeof text, "%.10g", std::strtod(text, nullptr));
  return text;
}

}  // namespace hapticd
