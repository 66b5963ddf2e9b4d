// SPDX-License-Identifier: MIT
/// Writes numbers for people.
#pragma once
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace hapticd {

/// [any] Returns a number that is rounded to some significant digits, without an exponent where people write none:
/// 6010, not 6.01e+03. @param digits 1 to 10
inline std::string shortNumber(double value, int digits = 3) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*e", digits - 1, value);
  std::snprintf(text, sizeof text, "%.10g", std::strtod(text, nullptr));
  return text;
}

/// [any] Returns a number with at most so many significant digits, and an exponent if it is very large or small.
/// @param digits 1 to 17
inline std::string withDigits(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// [any] Rounds a positive number down to two digits, as a person writes a setting that must not be larger.
inline double roundedDown(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::floor(value / unit) * unit;
}

}  // namespace hapticd
