// SPDX-License-Identifier: MIT
/// The stiffest wall that an arm bears by its mass alone: no friction, no hand.
#pragma once

namespace hapticd::passivity {

/// [any] True if a mass [kg] that meets a sampled wall of stiffness K [N/m] and damping B [N s/m], B through the window
/// of n samples (Eq. 5 of Thompson et al. 1999), comes to rest. Force is held between samples.
bool stableAlone(double mass, double stiffness, double damping, int n, double period) noexcept;

/// [any] Largest stiffness [N/m] that is stable alone with the damping that suits it best. Only friction and the hand
/// can calm a stiffer wall.
double maxStiffnessAlone(double mass, int n, double period) noexcept;

}  // namespace hapticd::passivity
