// SPDX-License-Identifier: MIT
/// The exact step of a mass on a spring and a damper.
#pragma once

namespace hapticd::medial {

inline constexpr double kLongestSettle = 3600;  ///< [s] an undamped body swings for ever, which this stands for

/// Material of one degree of freedom.
struct Oscillator {
  double mass = 1;       ///< m [kg], > 0
  double damping = 0;    ///< b [N s/m], >= 0
  double stiffness = 0;  ///< k [N/m], >= 0
};

/// The exact solution of m x'' + b x' + k x = 0 over a fixed time as a 2x2 matrix on (x, v): stable for every mass,
/// stiffness, damping and time, unlike the Euler steps, and it takes four multiplications. A constant force moves the
/// point about which x is measured to f / k.
struct OscillatorStep {
  double xx = 1, xv = 0, vx = 0, vv = 1;
  double xf = 0, vf = 0;  ///< what a constant force of 1 N adds over the time [m], [m/s]

  /// [any] Advances displacement x [m] and speed v [m/s].
  void advance(double& x, double& v) const noexcept {
    const double moved = xx * x + xv * v;
    v = vx * x + vv * v;
    x = moved;
  }
};

/// [any] The step of `dt` seconds. Computed in extended precision, so that 1e5 steps keep 1e-11 of the amplitude.
OscillatorStep oscillatorStep(const Oscillator& oscillator, double dt) noexcept;

/// [any] True if explicit Euler with this step decays: w^2 h < c and 4 - 2 c h + w^2 h^2 > 0 with c = b / m.
bool explicitEulerStable(const Oscillator& oscillator, double dt) noexcept;

/// [any] True if symplectic Euler with this step stays bounded: w^2 h^2 + 2 c h < 4.
bool symplecticEulerStable(const Oscillator& oscillator, double dt) noexcept;

}  // namespace hapticd::medial
