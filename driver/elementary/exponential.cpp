// SPDX-License-Identifier: MIT
/// Exponentials, logarithms and powers: reduction by powers of two, then series.
#include <cmath>
#include <limits>

#include "elementary/functions.hpp"
#include "elementary/series.hpp"

namespace hapticd::elementary {

namespace {

// ln 2 in two parts: products of the first part with whole numbers below 2^20 are exact.
constexpr double kLn2 = 0x1.62e42fef00000p-1, kLn2Rest = 0x1.473de6af278edp-34, kOverLn2 = 0x1.71547652b82fep+0;
constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

/// exp(x) = 2^n (1 + m).
struct Reduced {
  int n;
  double m;
};

/// exp(r + rest) - 1 for |r| <= 0.35.
double seriesLessOne(double r, double rest) noexcept {
  constexpr double kTerms[] = {1 / 2.0,         1 / 6.0,          1 / 24.0,         1 / 120.0,     1 / 720.0,
                               1 / 5040.0,      1 / 40320.0,      1 / 362880.0,     1 / 3628800.0, 1 / 39916800.0,
                               1 / 479001600.0, 1 / 6227020800.0, 1 / 87178291200.0};
  return r + (rest * (1 + r) + r * r * polynomial(kTerms, r));
}

Reduced reduced(double x) noexcept {
  const double n = nearestWhole(x * kOverLn2);
  const double most = x - n * kLn2, less = n * kLn2Rest, r = most - less;
  return {static_cast<int>(n), seriesLessOne(r, (most - r) - less)};
}

/// A number as the sum hi + lo.
struct Sum {
  double hi, lo;
};

Sum product(double a, double b) noexcept {  // Dekker 1971
  constexpr double kSplit = 0x1p27 + 1;
  const double ta = a * kSplit, a1 = ta - (ta - a), a2 = a - a1;
  const double tb = b * kSplit, b1 = tb - (tb - b), b2 = b - b1, p = a * b;
  return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

/// Natural logarithm of a finite positive number; with s = f / (2 + f), ln(1 + f) = 2 (s + s^3/3 + s^5/5 + ...).
Sum logarithmOf(double x) noexcept {
  int e = 0;
  double m = std::frexp(x, &e);
  if (m < 0x1.6a09e667f3bcdp-1) m *= 2, --e;  // 1/sqrt(2)
  const double f = m - 1, below = 2 + f, s = f / below, z = s * s;
  const Sum back = product(s, below);
  const double s_rest = ((f - back.hi) - back.lo - s * ((2 - below) + f)) / below;
  constexpr double kTerms[] = {1 / 3.0,  1 / 5.0,  1 / 7.0,  1 / 9.0,  1 / 11.0, 1 / 13.0,
                               1 / 15.0, 1 / 17.0, 1 / 19.0, 1 / 21.0, 1 / 23.0};
  const double small = 2 * (s_rest + s * z * polynomial(kTerms, z)) + e * kLn2Rest, most = e * kLn2;
  const double first = most + 2 * s,
               lost = std::fabs(most) > std::fabs(2 * s) ? (most - first) + 2 * s : (2 * s - first) + most;
  const double hi = first + (lost + small);
  return {hi, (first - hi) + (lost + small)};
}

/// x^n by squaring, for a small n.
double wholePower(double x, unsigned n) noexcept {
  double result = 1;
  for (; n > 0; n >>= 1, x *= x)
    if ((n & 1) != 0) result *= x;
  return result;
}

bool isOdd(double y) noexcept {
  return std::fabs(y) < 0x1p53 && std::fmod(y, 2) != 0;
}

/// x^y for x > 0, if neither is a special value.
double generalPower(double x, double y) noexcept {
  const Sum log = logarithmOf(x);
  const Sum p = product(log.hi, y);
  if (!(std::fabs(p.hi) < 800)) return p.hi > 0 ? kInf : 0;
  const double rest = p.lo + log.lo * y, power = exponential(p.hi);
  return power + power * rest;
}

}  // namespace

double exponential(double x) noexcept {
  if (std::isnan(x)) return x;
  if (x > 710) return kInf;
  if (x < -746) return 0;
  const Reduced r = reduced(x);
  return std::ldexp(1 + r.m, r.n);
}

double exponentialLessOne(double x) noexcept {
  if (std::isnan(x) || x == 0) return x;
  if (std::fabs(x) < 0.34) return seriesLessOne(x, 0);
  if (x > 710) return kInf;
  if (x < -40) return -1;
  const Reduced r = reduced(x);
  if (r.n > 60) return std::ldexp(1 + r.m, r.n);
  if (r.n < 0) return (std::ldexp(1.0, r.n) - 1) + std::ldexp(r.m, r.n);
  return std::ldexp((1 - std::ldexp(1.0, -r.n)) + r.m, r.n);
}

double logarithm(double x) noexcept {
  if (std::isnan(x) || x == kInf) return x;
  if (x < 0) return kNan;
  return x == 0 ? -kInf : logarithmOf(x).hi;
}

double logarithmOfOnePlus(double x) noexcept {
  if (!(x > -1)) return x == -1 ? -kInf : kNan;
  const double u = 1 + x;
  if (u == 1 || x == kInf) return x;
  return logarithm(u) + (x - (u - 1)) / u;  // corrects the rounding error of the sum u = 1 + x
}

double power(double x, double y) noexcept {
  constexpr double kSmall = 4;  // above it, squares lose more digits than logarithms do
  if (y == 0 || x == 1) return 1;
  if (std::isnan(x) || std::isnan(y)) return kNan;
  const double size = std::fabs(x);
  if (std::isinf(y)) return size == 1 ? 1 : (size > 1) == (y > 0) ? kInf : 0;
  const bool whole = std::trunc(y) == y, negative = std::signbit(x) && whole && isOdd(y);
  if (x == 0 || std::isinf(x)) {
    const double result = (x == 0) == (y > 0) ? 0 : kInf;
    return negative ? -result : result;
  }
  if (x < 0 && !whole) return kNan;
  if (std::fabs(y) <= kSmall && std::trunc(2 * y) == 2 * y) {
    const double n = std::trunc(std::fabs(y));
    double result = wholePower(x, static_cast<unsigned>(n));
    if (!whole) result *= std::sqrt(x);
    if (result != 0 && std::fabs(result) < kInf) return y > 0 ? result : 1 / result;
  }
  const double result = generalPower(size, y);
  return negative ? -result : result;
}

double hypotenuse(double x, double y) noexcept {
  if (std::isinf(x) || std::isinf(y)) return kInf;
  const double a = std::fabs(x), b = std::fabs(y), most = a > b ? a : b;
  if (most > 0x1p500) return 0x1p600 * std::sqrt((a * 0x1p-600) * (a * 0x1p-600) + (b * 0x1p-600) * (b * 0x1p-600));
  if (most < 0x1p-450) return 0x1p-600 * std::sqrt((a * 0x1p600) * (a * 0x1p600) + (b * 0x1p600) * (b * 0x1p600));
  return std::sqrt(a * a + b * b);
}

double hyperbolicTangent(double x) noexcept {
  if (std::isnan(x) || x == 0) return x;
  const double size = std::fabs(x);
  if (size > 22) return std::copysign(1.0, x);
  const double t = exponentialLessOne(2 * size);
  return std::copysign(t / (t + 2), x);
}

}  // namespace hapticd::elementary
