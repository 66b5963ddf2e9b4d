// SPDX-License-Identifier: MIT
/// The elementary functions against the C library's in extended precision, and their special values.
#include "elementary/functions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace hapticd::elementary {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

/// Error in units in the last place of the truth.
double unitsOff(double got, long double truth) {
  const auto nearest = static_cast<double>(truth);
  if (got == nearest) return static_cast<double>(std::fabs(static_cast<long double>(got) - truth)) == 0 ? 0 : 0.5;
  int exponent = 0;
  std::frexp(nearest, &exponent);
  const long double unit = std::ldexp(1.0L, std::max(exponent - 53, -1074));
  return static_cast<double>(std::fabs(static_cast<long double>(got) - truth) / unit);
}

struct Range {
  const char* name;
  double low, high;
  std::function<double(double)> ours;
  std::function<long double(long double)> truth;
};

TEST(Elementary, AreTrueToThreeUnitsInTheLastPlace) {
  using L = long double;
  const Range ranges[] = {{"sine", -7, 7, sine, [](L x) { return std::sin(x); }},
                          {"sine", -1e6, 1e6, sine, [](L x) { return std::sin(x); }},
                          {"sine", -1e10, 1e10, sine, [](L x) { return std::sin(x); }},
                          {"cosine", -7, 7, cosine, [](L x) { return std::cos(x); }},
                          {"cosine", -1e6, 1e6, cosine, [](L x) { return std::cos(x); }},
                          {"tangent", -7, 7, tangent, [](L x) { return std::tan(x); }},
                          {"arcTangent", -20, 20, arcTangent, [](L x) { return std::atan(x); }},
                          {"arcSine", -1, 1, arcSine, [](L x) { return std::asin(x); }},
                          {"arcCosine", -1, 1, arcCosine, [](L x) { return std::acos(x); }},
                          {"exponential", -740, 709, exponential, [](L x) { return std::exp(x); }},
                          {"exponential", -3, 3, exponential, [](L x) { return std::exp(x); }},
                          {"exponentialLessOne", -3, 3, exponentialLessOne, [](L x) { return std::expm1(x); }},
                          {"exponentialLessOne", -60, 700, exponentialLessOne, [](L x) { return std::expm1(x); }},
                          {"logarithm", 1e-300, 1e300, logarithm, [](L x) { return std::log(x); }},
                          {"logarithm", 0.5, 2, logarithm, [](L x) { return std::log(x); }},
                          {"logarithmOfOnePlus", -0.999, 10, logarithmOfOnePlus, [](L x) { return std::log1p(x); }},
                          {"hyperbolicTangent", -25, 25, hyperbolicTangent, [](L x) { return std::tanh(x); }}};
  std::mt19937_64 random(5);
  for (const Range& range : ranges) {
    std::uniform_real_distribution<double> values(range.low, range.high);
    for (int i = 0; i < 50'000; ++i) {
      double x = values(random);
      if (i % 4 == 0 && range.low < 0) x *= std::ldexp(1.0, -static_cast<int>(random() % 60));
      ASSERT_LE(unitsOff(range.ours(x), range.truth(x)), 3) << range.name << " of " << x;
    }
  }
}

TEST(Elementary, OfTwoNumbersAreTrueToFiveUnits) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> side(-5, 5), base(1e-3, 30), exponent(-9, 9);
  for (int i = 0; i < 200'000; ++i) {
    const double x = side(random), y = side(random), b = base(random);
    const double e = i % 3 == 0 ? std::round(2 * exponent(random)) / 2 : exponent(random);
    ASSERT_LE(unitsOff(angleOf(y, x), std::atan2(static_cast<long double>(y), x)), 3) << y << " " << x;
    ASSERT_LE(unitsOff(hypotenuse(x, y), std::hypot(static_cast<long double>(x), y)), 2) << y << " " << x;
    ASSERT_LE(unitsOff(power(b, e), std::pow(static_cast<long double>(b), e)), 5) << b << " " << e;
  }
}

/// As the C standard has them (Annex F), compared with the library's own.
TEST(Elementary, HaveTheSpecialValuesOfC) {
  const double values[] = {0.0, -0.0, 1, -1, 0.5, -0.5, 2, -2, 3, -3, 2.5, 1e300, -1e300, 5e-324, kInf, -kInf, kNan};
  const auto same = [](double ours, double c) {
    return (std::isnan(ours) && std::isnan(c)) || (std::signbit(ours) == std::signbit(c) &&
                                                   (ours == c || std::fabs(ours - c) <= 4e-16 * std::fabs(c) + 5e-324));
  };
  for (const double x : values) {
    if (std::fabs(x) < 1e100 || std::isinf(x) || std::isnan(x)) {
      EXPECT_TRUE(same(sine(x), std::sin(x))) << x;
      EXPECT_TRUE(same(cosine(x), std::cos(x))) << x;
      EXPECT_TRUE(same(tangent(x), std::tan(x))) << x;
    }
    EXPECT_TRUE(same(arcTangent(x), std::atan(x))) << x;
    EXPECT_TRUE(same(arcSine(x), std::asin(x))) << x;
    EXPECT_TRUE(same(arcCosine(x), std::acos(x))) << x;
    EXPECT_TRUE(same(exponential(x), std::exp(x))) << x;
    EXPECT_TRUE(same(exponentialLessOne(x), std::expm1(x))) << x;
    EXPECT_TRUE(same(logarithm(x), std::log(x))) << x;
    EXPECT_TRUE(same(logarithmOfOnePlus(x), std::log1p(x))) << x;
    EXPECT_TRUE(same(hyperbolicTangent(x), std::tanh(x))) << x;
    for (const double y : values) {
      EXPECT_TRUE(same(angleOf(y, x), std::atan2(y, x))) << y << " " << x << " " << angleOf(y, x);
      EXPECT_TRUE(same(power(x, y), std::pow(x, y))) << x << " " << y << " " << power(x, y) << " " << std::pow(x, y);
      EXPECT_TRUE(same(hypotenuse(x, y), std::hypot(x, y))) << x << " " << y;
    }
  }
}

TEST(Elementary, SineAndCosineBelongTogether) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> values(-1e3, 1e3);
  for (int i = 0; i < 100'000; ++i) {
    const double x = values(random);
    double s = 0, c = 0;
    sineAndCosine(x, &s, &c);
    ASSERT_EQ(s, sine(x));
    ASSERT_EQ(c, cosine(x));
    ASSERT_NEAR(s * s + c * c, 1, 4e-16);
  }
}

}  // namespace
}  // namespace hapticd::elementary
