// SPDX-License-Identifier: MIT
/// Calculates how stiff and how damped a sampled wall may be. Within these bounds the wall is passive, so that no
/// passive hand on it can oscillate.
/// Colgate & Schenkel 1997: b > T/2 max over w of Re{(1 - e^(-jwT)) H(e^(jwT))} / (1 - cos wT). The wall is
/// H(z) = z^-d (K + B (1 - z^-n) / (nT)), with stiffness K, damping B through the velocity window of n samples (Eq. 5
/// of Thompson et al. 1999), and a delay of d samples.
#pragma once

namespace hapticd::passivity {

/// The worst frequency of a velocity window: the minimum of the Dirichlet kernel D_n = sin((n + 1/2) theta) /
/// sin(theta/2).
struct WindowCoefficient {
  double value;  ///< c_n = (1 - min D_n) / (2n): damping B of the wall needs device damping c_n B
  double theta;  ///< the worst frequency, as w T [rad]
};
/// [any] Returns the worst frequency of a velocity window, and its coefficient. @param n samples of the window, >= 1
WindowCoefficient windowCoefficient(int n) noexcept;

/// [any] Returns the largest passive stiffness [N/m] for a device with damping `b` [N s/m]; 0 if no wall is passive.
/// @param damping B of the wall [N s/m]  @param n samples of the velocity window  @param delay d [samples]
/// @param period T [s]
double maxStiffness(double b, double damping, int n, int delay, double period) noexcept;

/// [any] Returns the largest stiffness [N/m] for a device with a position resolution Delta [m], Coulomb friction c [N]
/// and damping b [N s/m]: min(2b/T, 2c/Delta) (Abbott & Okamura 2005).
double maxStiffnessQuantised(double b, double friction, double resolution, double period) noexcept;

}  // namespace hapticd::passivity
