// SPDX-License-Identifier: MIT
/// How stiff and how damped a sampled wall may be so that no passive hand can be made to oscillate.
/// Colgate & Schenkel 1997: b > T/2 max over w of Re{(1 - e^(-jwT)) H(e^(jwT))} / (1 - cos wT), with the wall
/// H(z) = z^-d (K + B (1 - z^-n) / (nT)): stiffness K, damping B through the window of Eq. 5, d samples of delay.
#pragma once

namespace hapticd::passivity {

/// Where the window is worst: the least value of the Dirichlet kernel D_n = sin((n + 1/2) theta) / sin(theta/2).
struct WindowCoefficient {
  double value;  ///< c_n = (1 - min D_n) / (2n): damping B of the wall costs c_n B of the device's own damping
  double theta;  ///< w T at the minimum [rad]
};
/// [any] @param n samples of the window, >= 1
WindowCoefficient windowCoefficient(int n) noexcept;

/// [any] Damping [N s/m] the device must have for a wall without delay: K T/2 + c_n B; for B < 0, K T/2 + |B|.
double requiredDamping(double stiffness, double damping, int n, double period) noexcept;

/// [any] Largest passive stiffness [N/m] for a device of damping `b` [N s/m]; 0 if no wall is passive.
/// @param damping B of the wall [N s/m]  @param n its window  @param delay samples  @param period T [s]
double maxStiffness(double b, double damping, int n, int delay, double period) noexcept;

/// [any] Largest stiffness [N/m] that a measured position of step `resolution` [m] allows a device of Coulomb friction
/// `friction` [N] and damping `b`: min(2b/T, 2c/Delta) (Abbott & Okamura 2005).
double maxStiffnessQuantised(double b, double friction, double resolution, double period) noexcept;

}  // namespace hapticd::passivity
