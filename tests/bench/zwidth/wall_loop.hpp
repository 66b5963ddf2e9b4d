// SPDX-License-Identifier: MIT
/// A sampled wall in a loop with a device and a hand: how stiff may it be? Linear loops by their eigenvalues, quantised
/// ones by the energy that the nastiest motion draws from them.
#pragma once
#include <cstdint>

namespace hapticd::zwidth {

/// The wall as the daemon computes it, force held for a period: K x + B v with v by Eq. 5 over n samples, d samples
/// late.
struct Wall {
  double stiffness = 1000;  ///< K [N/m]
  double damping = 0;       ///< B [N s/m]
  int window = 1, delay = 0;
  double period = 1e-3;   ///< T [s]
  double resolution = 0;  ///< [m] of the measured position; 0: exact
};

/// What stands at the wall: the device, and the hand as a mass and a spring of its own, both without friction but the
/// device's. No hand is harder to hold still: every real one takes energy.
struct Body {
  double mass = 0.075;     ///< [kg] of device and hand
  double damping = 0.1;    ///< b [N s/m] of the device
  double friction = 0;     ///< c [N] Coulomb, of the device
  double hand_spring = 0;  ///< [N/m] to a point at rest
};

/// Largest modulus of the loop's eigenvalues, in contact: below 1 it settles, above 1 it grows.
double spectralRadius(const Wall& wall, const Body& body);

/// Largest stiffness [N/m] at which this body stays at rest; the wall's own is ignored. Below `from` counts as 0.
double stableStiffness(Wall wall, const Body& body, double from = 1e-3, double to = 1e7);

/// The same for the worst of a grid of hands: masses and springs over eight decades of their natural frequency.
double stableStiffnessWorstHand(Wall wall, const Body& device);

/// Net energy [J] that a hand puts into wall and device along a zigzag of `amplitude` [m] about `center` [m] that turns
/// after every `samples` samples, over one full turn, by the production wall law. Negative: the wall gives energy away.
double zigzagEnergy(const Wall& wall, const Body& device, double center, double amplitude, int samples);

/// Least of the zigzags' energies, over amplitudes, centres and lengths: negative if any motion draws energy.
double worstZigzagEnergy(const Wall& wall, const Body& device);

/// Largest stiffness [N/m] from which no zigzag draws energy.
double passiveStiffness(Wall wall, const Body& device);

/// Net energy [J] of a motion whose samples are cos(theta k), straight between them, per sample after `periods` of it;
/// by the production estimator and wall without its free side.
double sinusoidEnergy(const Wall& wall, const Body& device, double theta);

/// Speed after a bounce off the undamped wall over speed before it, the largest over the phases of sampling.
double restitution(const Wall& wall, double mass);

}  // namespace hapticd::zwidth
