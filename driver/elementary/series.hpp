// SPDX-License-Identifier: MIT
/// Helpers that the elementary functions share. The order of the operations matters, because it decides the last bits.
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

/// Returns the whole number nearest to x; of two equally near ones, the even one. Only for |x| < 2^51.
inline double nearestWhole(double x) noexcept {
  constexpr double kShift = 0x1.8p52;
  const double shifted = x + kShift;
  return shifted - kShift;
}

}  // namespace hapticd::elementary
