// SPDX-License-Identifier: MIT
/// How stiff a sampled wall may be in a loop with a device and a hand. Linear loops are judged by their eigenvalues.
/// Loops with quantised positions are judged by the energy that the worst motion draws from the wall.
#pragma once
#include <cstdint>

namespace hapticd::zwidth {

/// The wall as the daemon computes it. Its force K x + B v is held for a period and is d samples late. v comes from Eq.
/// 5 with a window of n samples.
struct Wall {
  double stiffness = 1000;  ///< K [N/m]
  double damping = 0;       ///< B [N s/m]
  int window = 1, delay = 0;
  double period = 1e-3;   ///< T [s]
  double resolution = 0;  ///< [m] resolution of the measured position; 0 means exact
};

/// The body at the wall: the device, and the hand as a mass with a spring. Only the device has friction. This is the
/// worst hand, because every real hand also dissipates energy.
struct Body {
  double mass = 0.075;     ///< [kg] mass of device and hand
  double damping = 0.1;    ///< b [N s/m] damping of the device
  double friction = 0;     ///< c [N] Coulomb friction of the device
  double hand_spring = 0;  ///< [N/m] spring between the hand and a point at rest
};

/// Returns the largest modulus of the loop's eigenvalues in contact. Below 1 the motion decays, above 1 it grows.
double spectralRadius(const Wall& wall, const Body& body);

/// Returns the largest stiffness [N/m] at which the loop with this body is stable; 0 if it is below `from`.
/// Wall::stiffness is ignored.
double stableStiffness(Wall wall, const Body& body, double from = 1e-3, double to = 1e7);

/// Returns the same for the worst of a grid of hands: their masses cover six decades, and their natural frequencies
/// 0.05 to 3.2 rad per sample.
double stableStiffnessWorstHand(Wall wall, const Body& device);

/// Returns the net energy [J] that a hand puts into wall and device over one period of a zigzag motion, by the
/// production wall law. If it is negative, the wall gives energy to the hand. @param center,amplitude [m] centre and
/// amplitude of the zigzag @param samples samples between two turning points
double zigzagEnergy(const Wall& wall, const Body& device, double center, double amplitude, int samples);

/// Returns the least energy over zigzags of many amplitudes, centres and lengths, scaled by a function of the
/// amplitude. It is negative if any of these motions draws energy.
double worstZigzagEnergy(const Wall& wall, const Body& device);

/// Returns the largest stiffness [N/m] up to which no zigzag draws energy.
double passiveStiffness(Wall wall, const Body& device);

/// Returns the mean energy [J] per sample that a motion puts into wall and device. Its samples are cos(theta k) [m],
/// with straight lines between them. The velocity comes from the production estimator. The wall is linear: it also
/// pulls.
double sinusoidEnergy(const Wall& wall, const Body& device, double theta);

/// Returns the ratio of the speeds after and before a bounce off the undamped wall, the largest over all phases of
/// sampling.
double restitution(const Wall& wall, double mass);

}  // namespace hapticd::zwidth
