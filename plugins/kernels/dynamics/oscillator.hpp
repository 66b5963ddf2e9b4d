// SPDX-License-Identifier: MIT
/// The linear oscillator m x'' + b x' + k x = f, stepped exactly.
#pragma once

namespace hapticd::dynamics {

/// The exact step. Let (x, v) be the state relative to the equilibrium x_e = f/k. The state one step later is a linear
/// map of the present state. Its four coefficients are computed once (the exponential of the 2x2 system matrix). The
/// step is stable for every m > 0, b >= 0, k >= 0 and every length.
struct OscillatorStep {
  double xx = 1, xv = 0;  ///< x' = xx x + xv v
  double vx = 0, vv = 1;  ///< v' = vx x + vv v
};

/// [rt] Returns the step over dt [s] for mass > 0 [kg], damping >= 0 [N s/m] and stiffness >= 0 [N/m], or for other
/// units in which b/m is in 1/s and k/m in 1/s^2. The numbers must be finite.
OscillatorStep oscillatorStep(double mass, double damping, double stiffness, double dt) noexcept;

/// [rt] Advances a motion about x = 0 without external force by one step. With a constant force f, pass x - f/k for x.
/// T is a scalar, or an Eigen vector or array.
template <class T>
inline void advance(const OscillatorStep& step, T& x, T& v) noexcept {
  const T moved = step.xx * x + step.xv * v;
  v = step.vx * x + step.vv * v;
  x = moved;
}

}  // namespace hapticd::dynamics
