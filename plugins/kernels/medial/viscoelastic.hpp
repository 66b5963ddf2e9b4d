// SPDX-License-Identifier: MIT
/// The material of a felt surface: a mass on a spring, a damper and, as an option, a relaxing branch (standard linear
/// solid). The spring of the contact lies in series between the mass and the probe.
#pragma once

namespace hapticd::medial {

/// The material of one point of a body as a hand feels it. In a slow press at the angular frequency w it has the
/// dynamic stiffness `stiffness + i w damping - w^2 mass`. With relaxation, the response to a step of the depth is
/// stiffness * (1 + share * exp(-t / time)).
struct Tissue {
  double stiffness = 0;         ///< [N/m] stiffness that a held press feels
  double damping = 0;           ///< [N s/m] damping that the hand feels
  double mass = 0;              ///< [kg] mass that the hand feels
  double relaxation_share = 0;  ///< additional stiffness of a fast press, divided by `stiffness`
  double relaxation_time = 0;   ///< [s] time constant of the relaxation
};

/// The same material in the form that is integrated: a mass on springs and a damper, and the contact spring between
/// this mass and the probe. Because the probe never touches the mass itself, the force does not jump when a contact
/// begins or ends. The contact spring and the spring of the surface in series have the stiffness Tissue::stiffness.
struct SurfaceElement {
  /// [N/m] spring between the probe and the surface; even the fastest press feels no greater stiffness
  double contact = 0;
  double stiffness = 0;    ///< [N/m] spring between the surface and its position at rest
  double damping = 0;      ///< [N s/m] damper parallel to `stiffness`
  double mass = 0;         ///< [kg] mass of the surface
  double branch = 0;       ///< [N/m] stiffness of the relaxing branch; 0 if there is none
  double branch_time = 0;  ///< [s] time constant with which the branch alone relaxes
};

/// [any] Returns the element that feels like `tissue`.
/// @param ratio stiffness of the contact spring divided by that of a fast press, > 1
SurfaceElement elementOf(const Tissue& tissue, double ratio) noexcept;

/// [any] Returns the element with enough damping that its contact does not oscillate from tick to tick. The contact is
/// solved by the midpoint rule, whose result alternates in sign if a motion decays in less than half a tick.
SurfaceElement dampedForTick(const SurfaceElement& element, double dt) noexcept;

/// The exact solution of an element over a fixed time under a constant force f [N], as a linear map of the displacement
/// x [m], its rate v [m/s] and y [m], the displacement to which the branch has relaxed.
struct ViscoelasticStep {
  double xx = 1, xv = 0, xy = 0, xf = 0;
  double vx = 0, vv = 1, vy = 0, vf = 0;
  double yx = 0, yv = 0, yy = 1, yf = 0;
};

/// [any] Returns the step of `dt` seconds for m x'' + b x' + k x + k1 (x - y) = f and y' = (x - y) / time. It is exact
/// for every material with mass or damping; a material with neither follows the force at once.
ViscoelasticStep viscoelasticStep(const SurfaceElement& element, double dt) noexcept;

/// [any] Returns the time [s] in which the motion of a free element decays from 1 m to `least` [m]; at most an hour.
double settleTime(const SurfaceElement& element, double least) noexcept;

}  // namespace hapticd::medial
