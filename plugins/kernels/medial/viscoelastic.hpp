// SPDX-License-Identifier: MIT
/// The material of a felt surface: a mass on a spring, a damper and, if asked for, a relaxing branch (standard linear
/// solid), with the spring of the contact in series between it and the probe.
#pragma once

namespace hapticd::medial {

/// What a hand feels of one place of a body while it presses slowly: stiffness + i w damping - w^2 mass. With a
/// relaxation, a step of the depth is met by stiffness * (1 + share * exp(-t / time)).
struct Tissue {
  double stiffness = 0;         ///< [N/m] of a held press
  double damping = 0;           ///< [N s/m]
  double mass = 0;              ///< [kg]
  double relaxation_share = 0;  ///< share of the stiffness that a fast press feels in addition
  double relaxation_time = 0;   ///< [s]
};

/// The same place as it is integrated. The spring of the contact stands between the probe and the surface: no change of
/// contact kicks, because the mass is behind it. In series with the other spring it gives Tissue::stiffness.
struct SurfaceElement {
  double contact = 0;      ///< [N/m] between the probe and the surface; no fast motion feels more than this
  double stiffness = 0;    ///< [N/m] between the surface and its place at rest
  double damping = 0;      ///< [N s/m]
  double mass = 0;         ///< [kg]
  double branch = 0;       ///< [N/m] of the relaxing branch; 0: there is none
  double branch_time = 0;  ///< [s] in which the branch alone forgets
};

/// [any] The element that feels like `tissue`. `ratio`: contact spring over the stiffness of a fast press, > 1.
SurfaceElement elementOf(const Tissue& tissue, double ratio) noexcept;

/// [any] The element with as much damping as keeps its contact from ringing from tick to tick: the contact is solved by
/// the midpoint rule, which answers with alternating signs what is over in less than half a tick.
SurfaceElement dampedForTick(const SurfaceElement& element, double dt) noexcept;

/// The exact solution of an element over a fixed time under a constant force f [N]: displacement x [m], its rate v, and
/// y [m], the displacement that the branch has relaxed to.
struct ViscoelasticStep {
  double xx = 1, xv = 0, xy = 0, xf = 0;
  double vx = 0, vv = 1, vy = 0, vf = 0;
  double yx = 0, yv = 0, yy = 1, yf = 0;
};

/// [any] The step of `dt` seconds: m x'' + b x' + k x + k1 (x - y) = f, y' = (x - y) / time. Exact for every material
/// with mass or damping; one with neither follows the force at once.
ViscoelasticStep viscoelasticStep(const SurfaceElement& element, double dt) noexcept;

/// [any] Time [s] after which no motion of a free element is left: from 1 m down to `least` [m]; at most an hour.
double settleTime(const SurfaceElement& element, double least) noexcept;

}  // namespace hapticd::medial
