// SPDX-License-Identifier: MIT
/// Calculates how stiff and how damped a sampled wall may be. Within these bounds the wall is passive, so that no
/// passive hand on it can oscillate.
/// Colgate & Schenkel 1997: b > T/2 max over w of Re{(1 - e^(-jwT)) H(e^(jwT))} / (1 - cos wT). The wall is
/// H(z) = z^-d (K + B (1 - z^-n) / (nT)), with stiffness K, damping B through the velocity window of n samples (Eq. 5
/// of Thompson et al. 1999), and a delay of d samples.
#pragma once
#include "wall_loop.hpp"

namespace hapticd::zwidth {

/// The worst frequency of a velocity window: the minimum of the Dirichlet kernel D_n = sin((n + 1/2) theta) /
/// sin(theta/2).
struct WindowCoefficient {
  double value;  ///< c_n = (1 - min D_n) / (2n): damping B of the wall needs device damping c_n B
  double theta;  ///< the worst frequency, as w T [rad]
};
/// Returns the worst frequency of a velocity window, and its coefficient. @param n samples of the window, >= 1
WindowCoefficient windowCoefficient(int n) noexcept;

/// Returns the largest passive stiffness [N/m] of a wall, whose own stiffness is ignored, for a device with this
/// damping; 0 if no wall is passive.
double maxStiffness(const Wall& wall, const Body& device) noexcept;

/// Returns the largest stiffness [N/m] for a device with Coulomb friction c and damping b, if the position has the
/// resolution Delta: min(2b/T, 2c/Delta) (Abbott & Okamura 2005).
double maxStiffnessQuantised(const Wall& wall, const Body& device) noexcept;

}  // namespace hapticd::zwidth
