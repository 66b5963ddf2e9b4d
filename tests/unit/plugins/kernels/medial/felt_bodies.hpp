// SPDX-License-Identifier: MIT
/// One place of a felt surface alone: a single node, pressed along its normal.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "kernels/medial/felt_surface.hpp"

namespace hapticd::medial::test {

inline constexpr double kRatio = 3;

/// A surface of one node that is pressed at one place.
class OnePlace {
 public:
  OnePlace(const Tissue& tissue, double dt, double ratio = kRatio)
      : tissue_(tissue), dt_(dt), nodes_(1, {Oscillator{}}, {}), surface_(nodes_, {tissue}, {1.0}, ratio, dt) {}

  /// One tick with the probe at this depth [m]. @returns the force [N] now
  double press(double depth) {
    FeltContact contact;
    contact.place.count = 1;
    contact.place.nodes[0] = {0, 1, 0, 0};
    contact.place.stiffness = tissue_.stiffness;
    contact.depth = depth;
    contact.known = known_;
    contact.before = before_;
    surface_.advance(dt_, {&contact, 1});
    before_ = contact.inside;
    known_ = true;
    mean = contact.mean;
    energy = surface_.energy({&contact, 1});
    return contact.force;
  }
  /// [m] by which the surface has given way.
  double shift() const { return -nodes_.displacement(0).z() - nodes_.displacement(0)[3]; }
  SurfaceElement element() const { return dampedForTick(elementOf(tissue_, kRatio), dt_); }

  double mean = 0;    ///< [N] over the last tick
  double energy = 0;  ///< [J]

 private:
  Tissue tissue_;
  double dt_, before_ = 0;
  bool known_ = false;
  Nodes nodes_;
  FeltSurface surface_;
};

/// What a hand feels of an element at one frequency w [rad/s]: contact spring and surface in series.
inline std::complex<double> impedance(const SurfaceElement& e, double w) {
  const std::complex<double> i(0, 1);
  std::complex<double> z = e.stiffness + i * w * e.damping - w * w * e.mass;
  if (e.branch > 0) z += e.branch * (i * w * e.branch_time) / (1.0 + i * w * e.branch_time);
  return 1.0 / (1.0 / e.contact + 1.0 / z);
}

/// The same, measured on the samples of a probe that oscillates: by least squares over whole periods, in contact.
inline std::complex<double> measuredImpedance(const Tissue& tissue, double hertz, double dt) {
  constexpr double kAmplitude = 1e-4, kBias = 1e-3;
  OnePlace place(tissue, dt);
  const double w = 2 * M_PI * hertz;
  const auto depth = [w](double t) { return kBias * std::min(1.0, w * t) + kAmplitude * std::sin(w * t); };
  place.press(depth(0));
  const auto period = static_cast<int>(std::lround(1 / (hertz * dt)));
  const int settle = period * static_cast<int>(std::ceil(6 * hertz) + 1);  // six seconds at least
  const int periods = std::max(1, static_cast<int>(hertz / 10));
  std::complex<double> force = 0, motion = 0;
  const std::complex<double> i(0, 1);
  for (int n = 1; n <= settle + periods * period; ++n) {
    const double now = depth(n * dt), f = place.press(now);
    if (n <= settle) continue;
    force += f * std::exp(-i * w * (n * dt));
    motion += now * std::exp(-i * w * (n * dt));
  }
  return force / motion;
}

/// The continuous motion of an element in contact, held or pressed by a ramp of the depth: its state
/// (x, v, y) by small steps.
class Continuous {
 public:
  explicit Continuous(const SurfaceElement& e) : element_(e) {}

  /// The state after `t` seconds from (x, v, y) while the depth runs from `depth` by `rate` [m/s].
  std::array<double, 3> contact(const std::array<double, 3>& from, double depth, double rate, double t) const {
    return run(from, depth, rate, t, element_.contact);
  }
  std::array<double, 3> free(const std::array<double, 3>& from, double t) const { return run(from, 0, 0, t, 0); }

 private:
  std::array<double, 3> run(std::array<double, 3> z, double depth, double rate, double t, double contact) const {
    const SurfaceElement& e = element_;
    const int steps = std::max(1, static_cast<int>(std::ceil(t / 2e-6)));  // classical Runge-Kutta: error below 1e-12
    const double h = t / steps;
    const auto slope = [&](const std::array<double, 3>& s, double d) -> std::array<double, 3> {
      const double pull = contact * (d - s[0]) - e.stiffness * s[0] - e.branch * (s[0] - s[2]);
      const double relaxing = e.branch > 0 ? (s[0] - s[2]) / e.branch_time : 0;
      if (e.mass > 0) return {s[1], (pull - e.damping * s[1]) / e.mass, relaxing};
      return {pull / e.damping, 0, relaxing};
    };
    const auto plus = [](std::array<double, 3> a, const std::array<double, 3>& b, double f) {
      for (std::size_t k = 0; k < 3; ++k) a[k] += f * b[k];
      return a;
    };
    for (int i = 0; i < steps; ++i) {
      const double d0 = depth + rate * h * i, d1 = d0 + .5 * rate * h, d2 = d0 + rate * h;
      const auto a = slope(z, d0), b = slope(plus(z, a, h / 2), d1), c = slope(plus(z, b, h / 2), d1);
      const auto d = slope(plus(z, c, h), d2);
      for (std::size_t k = 0; k < 3; ++k) z[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
    return z;
  }
  SurfaceElement element_;
};

}  // namespace hapticd::medial::test
