// SPDX-License-Identifier: MIT
#include "kernels/medial/oscillator.hpp"

#include "kernels/double_double/double_double.hpp"

namespace hapticd::medial {
namespace {

/// C(t) = cosh(q t) exp(-a t) and S(t) = sinh(q t) / q exp(-a t), for positive or negative q^2.
struct Pair {
  DoubleDouble c, s;
};

Pair underdamped(const DoubleDouble& a, const DoubleDouble& w2, const DoubleDouble& t) {
  const DoubleDouble w = sqrt(w2), decay = exp(-a * t);
  DoubleDouble sine, cosine;
  sincos(w * t, sine, cosine);
  return {decay * cosine, w > 0 ? decay * sine / w : decay * t};
}

/// Returns both in the overdamped case. It uses two falling exponentials instead of a growing hyperbolic function times
/// a falling exponential. The slow root is stiffness / (mass * fast root), because a - q would lose precision if the
/// damping is large.
Pair overdamped(const DoubleDouble& a, const DoubleDouble& q, const DoubleDouble& w0_squared, const DoubleDouble& t) {
  const DoubleDouble fast = a + q, slow = w0_squared / fast;
  const DoubleDouble e_fast = exp(-fast * t), e_slow = exp(-slow * t);
  const DoubleDouble difference = -e_slow * expm1(q * t * -2);
  return {(e_slow + e_fast) / 2, q > 0 ? difference / (q * 2) : e_slow * t};
}

}  // namespace

OscillatorStep oscillatorStep(const Oscillator& o, double dt) noexcept {
  const DoubleDouble m = o.mass, a = DoubleDouble(o.damping) / (m * 2), w2 = DoubleDouble(o.stiffness) / m, t = dt;
  const DoubleDouble w = sqrt(w2), q2 = (a - w) * (a + w);
  const Pair p = q2 < 0 ? underdamped(a, -q2, t) : overdamped(a, sqrt(q2), w2, t);
  OscillatorStep step;
  step.xx = static_cast<double>(p.c + a * p.s);
  step.xv = static_cast<double>(p.s);
  step.vx = static_cast<double>(-w2 * p.s);
  step.vv = static_cast<double>(p.c - a * p.s);
  if (o.stiffness > 0) step.xf = static_cast<double>((DoubleDouble(1) - (p.c + a * p.s)) / o.stiffness);
  step.vf = static_cast<double>(p.s / m);
  return step;
}

}  // namespace hapticd::medial
