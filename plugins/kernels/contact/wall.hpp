// SPDX-License-Identifier: MIT
/// Wall models: the force of a penetrated surface.
#pragma once

namespace hapticd::contact {

/// Material of a wall. Eq. 4 of Thompson et al. 1999 in units that make sense for every exponent n:
///   F = k x0 (x/x0)^n + lambda (x/x0)^n v
/// so that k stays a stiffness and lambda a damping. At n = 1 this is a linear spring whose damping grows with depth.
struct WallLaw {
  double stiffness = 800;     ///< k [N/m]: F = k x0 at depth x0
  double damping = 0;         ///< lambda [N s/m] at depth x0
  double exponent = 1;        ///< n
  double depth_scale = 1e-3;  ///< x0 [m]
};

struct WallForce {
  double force = 0;  ///< [N] along the outward normal, never negative: a wall does not pull
  double stiffness =
      0;               ///< [N/m] dF/dx before the clamp, at this speed; for n < 1 it grows beyond bounds toward depth 0
  double damping = 0;  ///< [N s/m] dF/dv before the clamp
};

/// [rt] Force at `depth` x [m] (> 0 inside) with `closing_speed` v [m/s] (> 0 going deeper), both relative to the wall:
/// so the force is the same in every inertial frame. Zero for x <= 0; starts from zero whatever the speed.
WallForce wallForce(const WallLaw& law, double depth, double closing_speed) noexcept;

/// [any] Slope dF/dx [N/m] of the elastic part where its force is `force` [N], and so the steepest that is met up to
/// there for n >= 1. For n < 1 the law is steepest at depth 0, beyond bounds: the slope at depth x0 is the answer.
double wallSlopeAt(const WallLaw& law, double force) noexcept;

/// [any] Depth [m] at which the elastic part pushes back with `force` [N]; infinite where it never does.
double wallDepthAt(const WallLaw& law, double force) noexcept;

/// [any] Energy [J] stored at `depth`: the integral of the elastic part.
double wallEnergy(const WallLaw& law, double depth) noexcept;

}  // namespace hapticd::contact
