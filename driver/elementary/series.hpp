// SPDX-License-Identifier: MIT
/// Small things that the elementary functions share. Every operation stands in the order in which it shall be done.
#pragma once
#include <cstddef>

namespace hapticd::elementary {

/// a[0] + a[1] z + a[2] z^2 + ..., by Horner's rule.
template <std::size_t N>
constexpr double polynomial(const double (&a)[N], double z) noexcept {
  double sum = a[N - 1];
  for (std::size_t i = N - 1; i > 0; --i) sum = a[i - 1] + z * sum;
  return sum;
}

/// The whole number nearest to x, ties to even; |x| < 2^51.
inline double nearestWhole(double x) noexcept {
  constexpr double kShift = 0x1.8p52;
  const double shifted = x + kShift;
  return shifted - kShift;
}

}  // namespace hapticd::elementary
