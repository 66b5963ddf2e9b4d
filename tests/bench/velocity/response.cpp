// SPDX-License-Identifier: MIT
#include "response.hpp"

#include <cmath>

namespace hapticd::velocity_bench {

WindowResponse windowResponse(int n, double rate, double frequency) noexcept {
  const double span = n / rate;
  const double half_turn = M_PI * frequency * span;
  return {2 * std::fabs(std::sin(half_turn)) / span, M_PI / 2 - std::fmod(half_turn, M_PI), span / 2, M_SQRT2 / span};
}

double idealTap(int n) noexcept {
  const double x = n - 0.5;
  return (n % 2 == 0 ? 1 : -1) / (M_PI * x * x);
}

}  // namespace hapticd::velocity_bench
