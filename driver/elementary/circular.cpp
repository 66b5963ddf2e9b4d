// SPDX-License-Identifier: MIT
/// Sine, cosine and their inverses: reduction to an eighth of a turn (Cody & Waite 1980), then Taylor's series.
#include <cmath>
#include <limits>

#include "elementary/functions.hpp"
#include "elementary/series.hpp"

namespace hapticd::elementary {

namespace {

// pi/2 in three parts: products of the first two with whole numbers below 2^20 are exact.
constexpr double kHalfPi1 = 0x1.921fb54400000p+0, kHalfPi2 = 0x1.0b4611a600000p-34, kHalfPi3 = 0x1.3198a2e037073p-69;
constexpr double kTwoOverPi = 0x1.45f306dc9c883p-1;
// The doubles nearest to pi and 2 pi, and the remainders to the exact numbers.
constexpr double kPi = 0x1.921fb54442d18p+1, kPiRest = 0x1.1a62633145c07p-53;
constexpr double kTurn = 0x1.921fb54442d18p+2, kTurnRest = 0x1.1a62633145c07p-52;
constexpr double kEighth = 0x1.921fb54442d18p-1;  // pi/4
constexpr double kMostQuarters = 0x1p20;

/// An angle minus a number of quarter turns: the rest is hi + lo, at most an eighth of a turn; the number is modulo 4.
struct Reduced {
  double hi, lo;
  int quarter;
};

Reduced reduced(double x) noexcept {
  double rest = 0;
  if (std::fabs(x) >= kMostQuarters) {  // fmod is exact; its divisor is not quite a turn
    const double left = std::fmod(x, kTurn);
    rest = -((x - left) / kTurn) * kTurnRest;
    x = left;
  }
  const double n = nearestWhole(x * kTwoOverPi);
  const double first = x - n * kHalfPi1, second = n * kHalfPi2;
  const double hi = first - second;
  double lo = (first - hi) - second;
  lo += rest - n * kHalfPi3;
  const double sum = hi + lo;
  return {sum, (hi - sum) + lo, static_cast<int>(static_cast<long>(n) & 3)};
}

/// The sine and cosine of hi + lo within an eighth of a turn.
double sineNear(double hi, double lo) noexcept {
  const double z = hi * hi;
  constexpr double kTerms[] = {-1 / 6.0,        1 / 120.0,        -1 / 5040.0,          1 / 362880.0,
                               -1 / 39916800.0, 1 / 6227020800.0, -1 / 1307674368000.0, 1 / 355687428096000.0};
  return hi + (hi * z * polynomial(kTerms, z) + lo * (1 - 0.5 * z));
}

double cosineNear(double hi, double lo) noexcept {
  const double z = hi * hi, half = 0.5 * z, most = 1 - half;
  constexpr double kTerms[] = {1 / 24.0,        -1 / 720.0,         1 / 40320.0,          -1 / 3628800.0,
                               1 / 479001600.0, -1 / 87178291200.0, 1 / 20922789888000.0, -1 / 6402373705728000.0};
  return most + (((1 - most) - half) + (z * z * polynomial(kTerms, z) - hi * lo));
}

bool isTurnable(double x) noexcept {
  return std::fabs(x) < std::numeric_limits<double>::infinity();
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void sineAndCosine(double x, double* s, double* c) noexcept {
  if (!isTurnable(x)) {
    *s = *c = kNan;
    return;
  }
  const Reduced r = std::fabs(x) <= kEighth ? Reduced{x, 0, 0} : reduced(x);
  const double sine = sineNear(r.hi, r.lo), cosine = cosineNear(r.hi, r.lo);
  const double odd = (r.quarter & 1) != 0 ? cosine : sine, even = (r.quarter & 1) != 0 ? sine : cosine;
  *s = (r.quarter & 2) != 0 ? -odd : odd;
  *c = r.quarter == 1 || r.quarter == 2 ? -even : even;
}

double sine(double x) noexcept {
  double s, c;
  sineAndCosine(x, &s, &c);
  return x == 0 ? x : s;  // keeps the sign of zero
}

double cosine(double x) noexcept {
  double s, c;
  sineAndCosine(x, &s, &c);
  return c;
}

double tangent(double x) noexcept {
  double s, c;
  sineAndCosine(x, &s, &c);
  return x == 0 ? x : s / c;
}

namespace {

/// Arc tangent for 0 to 1: looks up the arc of the nearest eighth (k/8), and adds the arc of the rest by the addition
/// theorem of the tangent.
double arcOfFraction(double x) noexcept {
  constexpr double kArcs[] = {0x0.0p+0,
                              0x1.fd5ba9aac2f6ep-4,
                              0x1.f5b75f92c80ddp-3,
                              0x1.6f61941e4def1p-2,
                              0x1.dac670561bb4fp-2,
                              0x1.1e00babdefeb4p-1,
                              0x1.4978fa3269ee1p-1,
                              0x1.700a7c5784634p-1,
                              0x1.921fb54442d18p-1};
  constexpr double kRests[] = {0x0.0p+0,
                               -0x1.cd37686760c17p-59,
                               0x1.8ab6e3cf7afbdp-57,
                               -0x1.c63aae6f6e918p-56,
                               0x1.a2b7f222f65e2p-56,
                               -0x1.928df287a668fp-58,
                               0x1.2419a87f2a458p-56,
                               -0x1.8c34d25aadef6p-56,
                               0x1.1a62633145c07p-55};
  const int k = static_cast<int>(8 * x + 0.5);
  const double c = 0.125 * k, t = k == 0 ? x : (x - c) / (1 + x * c), z = t * t;
  constexpr double kTerms[] = {-1 / 3.0, 1 / 5.0, -1 / 7.0, 1 / 9.0, -1 / 11.0, 1 / 13.0};
  return kArcs[k] + (t + (kRests[k] + t * z * polynomial(kTerms, z)));
}

}  // namespace

double angleOf(double y, double x) noexcept {
  if (std::isnan(x) || std::isnan(y)) return kNan;
  const double up = std::fabs(y), out = std::fabs(x);
  double angle;  // angle of (out, up), in the first quarter
  if (up == 0) {
    angle = 0;
  } else if (std::isinf(up) && std::isinf(out)) {
    angle = kEighth;
  } else if (up <= out) {
    angle = arcOfFraction(up / out);
  } else {
    angle = 0.5 * kPi - (arcOfFraction(out / up) - 0.5 * kPiRest);
  }
  if (std::signbit(x)) angle = kPi - (angle - kPiRest);
  return std::copysign(angle, y);
}

double arcTangent(double x) noexcept {
  return x == 0 ? x : angleOf(x, 1);
}

double arcSine(double x) noexcept {
  return std::fabs(x) <= 1 ? angleOf(x, std::sqrt((1 - x) * (1 + x))) : kNan;
}

double arcCosine(double x) noexcept {
  return std::fabs(x) <= 1 ? angleOf(std::sqrt((1 - x) * (1 + x)), x) : kNan;
}

}  // namespace hapticd::elementary
