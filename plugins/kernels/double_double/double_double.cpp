// SPDX-License-Identifier: MIT
#include "kernels/double_double/double_double.hpp"

namespace hapticd {
namespace {

constexpr DoubleDouble kLn2{0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr double kLn2Rest = 0x1.7b57a079a1934p-111;
constexpr DoubleDouble kHalfPi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr double kHalfPiRest = -0x1.f1976b7ed8fbcp-110;

/// Returns exp(a) - 1 for |a| <= 0.35: the series of a / 512, then nine times exp(2x) - 1 = 2 s + s^2 with s = exp(x) -
/// 1.
DoubleDouble smallExpm1(const DoubleDouble& a) noexcept {
  constexpr int kHalvings = 9, kTerms = 9;  // (0.35 / 512)^9 / 10! is 1e-35
  const DoubleDouble x = ldexp(a, -kHalvings);
  DoubleDouble sum = x, term = x;
  for (int k = 2; k <= kTerms; ++k) {
    term = term * x / k;
    sum += term;
  }
  for (int i = 0; i < kHalvings; ++i) sum = ldexp(sum, 1) + sum * sum;
  return sum;
}

/// Returns the sum of x - x^3/3! + x^5/5! - ..., or of 1 - x^2/2! + ..., from the first term on, which has x^power.
DoubleDouble alternating(DoubleDouble term, int power, const DoubleDouble& square) noexcept {
  constexpr double kEnough = 1e-34;
  DoubleDouble sum = term;
  while (std::abs(term.high) > kEnough) {
    term = -term * square / (double{power + 1.0} * (power + 2));
    sum += term;
    power += 2;
  }
  return sum;
}

}  // namespace

DoubleDouble sqrt(const DoubleDouble& a) noexcept {
  if (!(a.high > 0)) return 0.0;
  const double root = std::sqrt(a.high);
  const DoubleDouble better = quickSum(root, (a - exactProduct(root, root)).high / (2 * root));
  return better + (a - better * better).high / (2 * root);
}

DoubleDouble exp(const DoubleDouble& a) noexcept {
  constexpr double kMost = 667;  // exp(667) is 5e289
  if (!(std::abs(a.high) < kMost)) return std::exp(a.high);
  const double powers = std::nearbyint(a.high / kLn2.high);
  const DoubleDouble rest = a - kLn2 * powers - kLn2Rest * powers;
  return ldexp(smallExpm1(rest) + 1.0, static_cast<int>(powers));
}

DoubleDouble expm1(const DoubleDouble& a) noexcept {
  return std::abs(a.high) <= 0.35 ? smallExpm1(a) : exp(a) - 1.0;
}

void sincos(const DoubleDouble& angle, DoubleDouble& sine, DoubleDouble& cosine) noexcept {
  if (!(std::abs(angle.high) < 1e9)) {
    sine = std::sin(angle.high);
    cosine = std::cos(angle.high);
    return;
  }
  const double turns = std::nearbyint(angle.high / kHalfPi.high);
  const DoubleDouble rest =
      angle - exactProduct(kHalfPi.high, turns) - exactProduct(kHalfPi.low, turns) - kHalfPiRest * turns;
  const DoubleDouble square = rest * rest, s = alternating(rest, 1, square), c = alternating(1.0, 0, square);
  const int quarter = static_cast<int>(std::fmod(turns, 4)) & 3;
  sine = quarter == 0 ? s : quarter == 1 ? c : quarter == 2 ? -s : -c;
  cosine = quarter == 0 ? c : quarter == 1 ? -s : quarter == 2 ? -c : s;
}

}  // namespace hapticd
