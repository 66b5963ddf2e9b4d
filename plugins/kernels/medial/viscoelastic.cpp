// SPDX-License-Identifier: MIT
#include "kernels/medial/viscoelastic.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/double_double/double_double.hpp"
#include "kernels/medial/oscillator.hpp"

namespace hapticd::medial {
namespace {

constexpr int kSize = 4;    ///< size of the matrix: x, v, y and the force
constexpr int kTerms = 20;  ///< terms of the exponential series of a matrix of norm 1/2; the error is below 1e-24

using Matrix = std::array<std::array<DoubleDouble, kSize>, kSize>;

Matrix product(const Matrix& a, const Matrix& b) noexcept {
  Matrix c{};
  for (std::size_t i = 0; i < kSize; ++i)
    for (std::size_t k = 0; k < kSize; ++k)
      for (std::size_t j = 0; j < kSize; ++j) c[i][j] += a[i][k] * b[k][j];
  return c;
}

Matrix identity() noexcept {
  Matrix one{};
  for (std::size_t i = 0; i < kSize; ++i) one[i][i] = 1;
  return one;
}

/// Returns exp(a) by scaling and squaring: halves `a` repeatedly, sums the series, and squares the result (Golub & Van
/// Loan, Matrix Computations, 9.3.1).
Matrix exponential(Matrix a) noexcept {
  DoubleDouble norm = 0;
  for (const auto& row : a) {
    DoubleDouble sum = 0;
    for (const DoubleDouble& x : row) sum += abs(x);
    norm = std::max(norm, sum);
  }
  const int halvings = norm > 0.5 ? std::max(0, std::ilogb(norm.high) + 2) : 0;
  for (auto& row : a)
    for (DoubleDouble& x : row) x = ldexp(x, -halvings);
  Matrix sum = identity(), term = identity();
  for (int k = 1; k <= kTerms; ++k) {
    term = product(term, a);
    for (auto& row : term)
      for (DoubleDouble& x : row) x /= k;
    for (std::size_t i = 0; i < kSize; ++i)
      for (std::size_t j = 0; j < kSize; ++j) sum[i][j] += term[i][j];
  }
  for (int i = 0; i < halvings; ++i) sum = product(sum, sum);
  return sum;
}

/// Returns the step of an element without mass, which creeps: its rate is not a state.
ViscoelasticStep creep(const SurfaceElement& e, double dt) noexcept {
  ViscoelasticStep step{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  if (!(e.stiffness > 0)) return step;
  const double decay = e.damping > 0 ? -std::expm1(-e.stiffness / e.damping * dt) : 1;
  step.xx = 1 - decay;
  step.xf = decay / e.stiffness;
  return step;
}

ViscoelasticStep oscillate(const SurfaceElement& e, double dt) noexcept {
  const OscillatorStep o = oscillatorStep({e.mass, e.damping, e.stiffness}, dt);
  return {o.xx, o.xv, 0, o.xf, o.vx, o.vv, 0, o.vf, 0, 0, 0, 0};
}

/// Returns the step of an element with a branch, from the exponential of the whole system. Without mass, the rate
/// follows from the other states.
ViscoelasticStep relax(const SurfaceElement& e, double dt) noexcept {
  Matrix a{};
  const DoubleDouble k = DoubleDouble(e.stiffness) + e.branch, k1 = e.branch, b = e.damping, m = e.mass;
  const bool heavy = e.mass > 0;
  if (heavy) {
    a[0][1] = 1;
    a[1] = {-k / m, -b / m, k1 / m, 1 / m};
  } else {
    a[0] = {-k / b, 0, k1 / b, 1 / b};
  }
  const DoubleDouble rate = DoubleDouble(1) / e.branch_time;
  a[2] = {rate, 0, -rate, 0};
  for (auto& row : a)
    for (DoubleDouble& x : row) x *= dt;
  const Matrix s = exponential(a);
  const auto at = [&s](std::size_t i, std::size_t j) { return static_cast<double>(s[i][j]); };
  ViscoelasticStep step{at(0, 0), at(0, 1), at(0, 2), at(0, 3), at(1, 0), at(1, 1),
                        at(1, 2), at(1, 3), at(2, 0), at(2, 1), at(2, 2), at(2, 3)};
  if (!heavy) step.vv = 0;
  return step;
}

}  // namespace

SurfaceElement elementOf(const Tissue& t, double ratio) noexcept {
  SurfaceElement e;
  if (!(t.stiffness > 0)) return e;
  const double fast = t.stiffness * (1 + std::max(0.0, t.relaxation_share));
  e.contact = ratio * fast;
  // solves 1/felt = 1/contact + 1/x for x
  const auto behind = [&e](double felt) { return felt * e.contact / (e.contact - felt); };
  e.stiffness = behind(t.stiffness);
  // share of a small change of the element that the probe feels
  const double share = (1 - 1 / ratio) * (1 - 1 / ratio);
  e.damping = t.damping / share;
  e.mass = t.mass / share;
  if (t.relaxation_share > 0 && t.relaxation_time > 0) {
    e.branch = behind(fast) - e.stiffness;
    const double held = e.contact + e.stiffness;
    e.branch_time = t.relaxation_time * held / (held + e.branch);  // the other springs slow down the relaxation
  }
  return e;
}

SurfaceElement dampedForTick(const SurfaceElement& element, double dt) noexcept {
  SurfaceElement e = element;
  const double stiffest = e.contact + e.stiffness + e.branch;
  if (4 * e.mass < stiffest * dt * dt) e.damping = std::max(e.damping, 0.5 * stiffest * dt);
  return e;
}

ViscoelasticStep viscoelasticStep(const SurfaceElement& e, double dt) noexcept {
  if (e.branch > 0 && (e.mass > 0 || e.damping > 0)) return relax(e, dt);
  return e.mass > 0 ? oscillate(e, dt) : creep(e, dt);
}

double settleTime(const SurfaceElement& e, double least) noexcept {
  if (!(e.stiffness > 0)) return 0;
  const double half = 0.5 * e.damping, discriminant = half * half - e.mass * e.stiffness;
  double rate = !(e.mass > 0)       ? (e.damping > 0 ? e.stiffness / e.damping : HUGE_VAL)
                : discriminant <= 0 ? half / e.mass
                                    : e.stiffness / (half + std::sqrt(discriminant));
  if (e.branch > 0) rate = 1 / (1 / rate + e.branch_time * (e.stiffness + e.branch) / e.stiffness);
  const double time = std::log(1 / least) / rate;
  return time < kLongestSettle ? time : kLongestSettle;
}

}  // namespace hapticd::medial
