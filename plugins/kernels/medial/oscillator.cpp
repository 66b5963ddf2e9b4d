// SPDX-License-Identifier: MIT
#include "kernels/medial/oscillator.hpp"

#include <cmath>

namespace hapticd::medial {
namespace {

/// C(t) = cosh(q t) exp(-a t) and S(t) = sinh(q t) / q exp(-a t), for positive or negative q^2.
struct Pair {
  long double c, s;
};

Pair underdamped(long double a, long double w2, long double t) {
  const long double w = std::sqrt(w2), decay = std::exp(-a * t);
  return {decay * std::cos(w * t), w > 0 ? decay * std::sin(w * t) / w : decay * t};
}

/// Returns both in the overdamped case. It uses two falling exponentials instead of a growing hyperbolic function times
/// a falling exponential. The slow root is stiffness / (mass * fast root), because a - q would lose precision if the
/// damping is large.
Pair overdamped(long double a, long double q, long double w0_squared, long double t) {
  const long double fast = a + q, slow = w0_squared / fast;
  const long double e_fast = std::exp(-fast * t), e_slow = std::exp(-slow * t);
  const long double difference = -e_slow * std::expm1(-2 * q * t);
  return {(e_slow + e_fast) / 2, q > 0 ? difference / (2 * q) : e_slow * t};
}

}  // namespace

OscillatorStep oscillatorStep(const Oscillator& o, double dt) noexcept {
  const long double m = o.mass, a = o.damping / (2 * m), w2 = o.stiffness / m, t = dt;
  const long double q2 = (a - std::sqrt(w2)) * (a + std::sqrt(w2));
  const Pair p = q2 < 0 ? underdamped(a, -q2, t) : overdamped(a, std::sqrt(q2), w2, t);
  OscillatorStep step;
  step.xx = static_cast<double>(p.c + a * p.s);
  step.xv = static_cast<double>(p.s);
  step.vx = static_cast<double>(-w2 * p.s);
  step.vv = static_cast<double>(p.c - a * p.s);
  if (o.stiffness > 0) step.xf = static_cast<double>((1 - (p.c + a * p.s)) / o.stiffness);
  step.vf = static_cast<double>(p.s / m);
  return step;
}

bool explicitEulerStable(const Oscillator& o, double h) noexcept {
  const double c = o.damping / o.mass, w2 = o.stiffness / o.mass;
  return w2 * h < c && 4 - 2 * c * h + w2 * h * h > 0;
}

bool symplecticEulerStable(const Oscillator& o, double h) noexcept {
  const double c = o.damping / o.mass, w2 = o.stiffness / o.mass;
  return w2 * h * h + 2 * c * h < 4;
}

}  // namespace hapticd::medial
