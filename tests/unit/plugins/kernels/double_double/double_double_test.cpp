// SPDX-License-Identifier: MIT
#include "kernels/double_double/double_double.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace hapticd {
namespace {

constexpr double kExact = 1e-31, kFunction = 1e-29;

/// |a - b|, relative to `scale`
double error(const DoubleDouble& a, const DoubleDouble& b, double scale) {
  return std::abs((a - b).high) / scale;
}

TEST(DoubleDouble, TheFourOperationsUndoOneAnother) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> mantissa(1, 2), exponent(-100, 100);
  for (int i = 0; i < 20000; ++i) {
    const auto any = [&] {
      const double high = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
      return quickSum(high, high * 1e-17 * (mantissa(random) - 1.5));
    };
    const DoubleDouble a = any(), b = any();
    EXPECT_LT(error(a / b * b, a, a.high), kExact);
    EXPECT_LT(error(a * b / b, a, a.high), kExact);
    EXPECT_LT(error(sqrt(a) * sqrt(a), a, a.high), kExact);
    EXPECT_LT(error((a + b) - b, a, std::max(a.high, b.high)), kExact);
  }
}

TEST(DoubleDouble, TheFunctionsHaveTheirClosedForms) {
  // to 32 digits: e, 1 - 1/e, sin 1, cos 1
  EXPECT_LT(error(exp(1.0), {2.718281828459045, 1.4456468917292502e-16}, 1), kFunction);
  EXPECT_LT(error(-expm1(-1.0), DoubleDouble(1.0) - DoubleDouble(1.0) / exp(1.0), 1), kFunction);
  DoubleDouble s, c;
  sincos(1.0, s, c);
  EXPECT_LT(error(s, {0.8414709848078965, 1.776845092935536e-18}, 1), kFunction);
  EXPECT_LT(error(c, {0.5403023058681398, -4.760954612604417e-17}, 1), kFunction);
}

TEST(DoubleDouble, TheFunctionsKeepTheirIdentities) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> small(-0.3, 0.3), large(-300, 300), turns(-1e6, 1e6);
  for (int i = 0; i < 5000; ++i) {
    const DoubleDouble x = small(random), y = large(random), angle = turns(random);
    EXPECT_LT(error(exp(y) * exp(-y), 1.0, 1), 600 * kFunction) << y.high;
    EXPECT_LT(error(expm1(x), exp(x) - 1.0, 1), kFunction) << x.high;
    EXPECT_LT(error(expm1(x) * 0.5, expm1(x * 0.5) + expm1(x * 0.5) * expm1(x * 0.5) * 0.5, std::abs(x.high)),
              kFunction);
    DoubleDouble s, c, s2, c2;
    sincos(angle, s, c);
    sincos(angle * 2.0, s2, c2);
    EXPECT_LT(error(s * s + c * c, 1.0, 1), kFunction) << angle.high;
    EXPECT_LT(error(s2, s * c * 2.0, 1), 1e6 * kFunction) << angle.high;
    EXPECT_LT(error(c2, c * c - s * s, 1), 1e6 * kFunction) << angle.high;
  }
}

TEST(DoubleDouble, TheFunctionsTakeWhatHasNoSuchNumber) {
  const double infinity = std::numeric_limits<double>::infinity(), none = std::numeric_limits<double>::quiet_NaN();
  DoubleDouble s, c;
  EXPECT_EQ(exp(-1e6).high, 0);
  EXPECT_EQ(exp(-infinity).high, 0);
  EXPECT_EQ(exp(1e6).high, infinity);
  EXPECT_TRUE(std::isnan(exp(none).high));
  sincos(infinity, s, c);
  EXPECT_TRUE(std::isnan(s.high) && std::isnan(c.high));
  sincos(1e12, s, c);
  EXPECT_NEAR(s.high, std::sin(1e12), 1e-15);
}

/// Compared with functions of the C library in the greatest precision that this machine has.
TEST(DoubleDouble, TheFunctionsAgreeWithTheLibrary) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-20, 2.5);
  for (int i = 0; i < 20000; ++i) {
    const double x = -std::pow(10, exponent(random));
    const auto wide = [](const DoubleDouble& a) { return static_cast<long double>(a.high) + a.low; };
    const long double t = x;
    EXPECT_NEAR(wide(exp(x)) / std::exp(t), 1, 1e-18L) << x;
    EXPECT_NEAR(wide(expm1(x)) / std::expm1(t), 1, 1e-18L) << x;
    DoubleDouble s, c;
    sincos(x, s, c);
    EXPECT_NEAR(wide(s), std::sin(t), 1e-18L) << x;
    EXPECT_NEAR(wide(c), std::cos(t), 1e-18L) << x;
  }
}

}  // namespace
}  // namespace hapticd
