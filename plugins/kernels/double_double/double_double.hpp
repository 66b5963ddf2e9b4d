// SPDX-License-Identifier: MIT
/// Numbers of 106 bits as unevaluated sums of two doubles (Dekker, "A floating-point technique for extending the
/// available precision", 1971; Hida, Li & Bailey, "Algorithms for quad-double precision floating point arithmetic",
/// 2001). They are for setting up: what a tick reads is rounded to double. A long double would be faster on x86, but it
/// has 64 bits there and 113 on arm64, so its results would differ in the last bit of a double; these are the same
/// everywhere. Errors are below 1e-31 times the result for sums, products, quotients and roots, and below 1e-29 times
/// the result (sine, cosine: 1) and the argument, if that is above 1, for functions. Sums, products, quotients and
/// roots need numbers between 1e-290 and 1e290.
#pragma once
#include <cmath>

namespace hapticd {

struct DoubleDouble {
  double high = 0, low = 0;  ///< the value is high + low; high is that sum, rounded

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double value) : high(value) {}  // implicit: each double is one of these numbers
  constexpr DoubleDouble(double h, double l) : high(h), low(l) {}

  explicit operator double() const noexcept { return high; }
};

/// Returns a + b exactly, for |a| >= |b| or a = 0.
inline DoubleDouble quickSum(double a, double b) noexcept {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// Returns a + b exactly.
inline DoubleDouble exactSum(double a, double b) noexcept {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// Returns a * b exactly.
inline DoubleDouble exactProduct(double a, double b) noexcept {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

inline DoubleDouble operator-(const DoubleDouble& a) noexcept {
  return {-a.high, -a.low};
}
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  DoubleDouble sum = exactSum(a.high, b.high);
  const DoubleDouble rest = exactSum(a.low, b.low);
  sum = quickSum(sum.high, sum.low + rest.high);
  return quickSum(sum.high, sum.low + rest.low);
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  return a + -b;
}
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  const DoubleDouble product = exactProduct(a.high, b.high);
  return quickSum(product.high, product.low + (a.high * b.low + a.low * b.high));
}
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  const double first = a.high / b.high;
  DoubleDouble rest = a - b * first;
  const double second = rest.high / b.high;
  rest = rest - b * second;
  return quickSum(first, second) + rest.high / b.high;
}
inline DoubleDouble& operator+=(DoubleDouble& a, const DoubleDouble& b) noexcept {
  return a = a + b;
}
inline DoubleDouble& operator*=(DoubleDouble& a, const DoubleDouble& b) noexcept {
  return a = a * b;
}
inline DoubleDouble& operator/=(DoubleDouble& a, const DoubleDouble& b) noexcept {
  return a = a / b;
}
inline bool operator<(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  return a.high < b.high || (a.high == b.high && a.low < b.low);
}
inline bool operator>(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  return b < a;
}
inline bool operator<=(const DoubleDouble& a, const DoubleDouble& b) noexcept {
  return a < b || (a.high == b.high && a.low == b.low);
}

inline DoubleDouble abs(const DoubleDouble& a) noexcept {
  return a.high < 0 ? -a : a;
}
/// Returns a * 2^exponent exactly.
inline DoubleDouble ldexp(const DoubleDouble& a, int exponent) noexcept {
  return {std::ldexp(a.high, exponent), std::ldexp(a.low, exponent)};
}

DoubleDouble sqrt(const DoubleDouble& a) noexcept;   ///< [any] of a >= 0
DoubleDouble exp(const DoubleDouble& a) noexcept;    ///< [any] with 53 bits beyond 1e-290 and 1e290
DoubleDouble expm1(const DoubleDouble& a) noexcept;  ///< [any] exp(a) - 1, accurate near 0
/// [any] Sets the sine and cosine of an angle [rad]; with the precision of a double from 1e9 on.
void sincos(const DoubleDouble& angle, DoubleDouble& sine, DoubleDouble& cosine) noexcept;

}  // namespace hapticd
