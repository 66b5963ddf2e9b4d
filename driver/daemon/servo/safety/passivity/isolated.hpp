// SPDX-License-Identifier: MIT
/// Calculates the stiffest wall, and the strongest damping, that are stable for an arm that has only mass: it has no
/// friction, and no hand holds it.
#pragma once

namespace hapticd::passivity {

/// [any] Returns the largest stiffness [N/m] that is stable without friction and without a hand, with the best damping.
/// A stiffer wall needs friction or a hand to be stable. The damping uses the velocity window of n samples (Eq. 5 of
/// Thompson et al. 1999). @param mass [kg] that the hand would feel  @param period T of the servo [s]
double maxStiffnessAlone(double mass, int n, double period) noexcept;

/// [any] Returns the largest damping [N s/m] that is stable without friction, in a wall that has hardly any stiffness.
/// The parameters are those of maxStiffnessAlone().
double maxDampingAlone(double mass, int n, double period) noexcept;

}  // namespace hapticd::passivity
