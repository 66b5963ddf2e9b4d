// SPDX-License-Identifier: MIT
/// The linear oscillator m x'' + b x' + k x = f, stepped exactly.
#pragma once

namespace hapticd::dynamics {

/// The state (x, v) one step later is a linear map of the state now and of the equilibrium x_e = f/k: four numbers,
/// computed once (the exponential of the 2x2 system matrix). Stable for every m > 0, b >= 0, k >= 0 and every step.
struct OscillatorStep {
  double xx = 1, xv = 0;  ///< x' = xx x + xv v
  double vx = 0, vv = 1;  ///< v' = vx x + vv v
};

/// [main] The step for mass [kg], damping [N s/m], stiffness [N/m] (any unit that makes b/m and k/m rates) over dt [s].
/// @throws std::invalid_argument unless mass > 0, damping >= 0, stiffness >= 0, dt >= 0 and all are finite.
OscillatorStep oscillatorStep(double mass, double damping, double stiffness, double dt);

/// [rt] The same without a check, for a dt that varies; the caller is responsible for the arguments.
OscillatorStep oscillatorStepUnchecked(double mass, double damping, double stiffness, double dt) noexcept;

/// [rt] Free motion about 0. With a constant force f shift by the equilibrium: advance(step, x - f/k, v).
/// T: a scalar or an Eigen vector or array.
template <class T>
inline void advance(const OscillatorStep& step, T& x, T& v) noexcept {
  const T moved = step.xx * x + step.xv * v;
  v = step.vx * x + step.vv * v;
  x = moved;
}

}  // namespace hapticd::dynamics
