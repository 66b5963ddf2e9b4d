// SPDX-License-Identifier: MIT
/// Contact laws: the force of a surface on a probe below it.
#pragma once

namespace hapticd::contact {

/// Material of a wall: Eq. 4 of Thompson et al. 1999, written so that the units do not depend on the exponent n:
///   F = k x0 (x/x0)^n + lambda (x/x0)^n v
/// with the depth x, the closing speed v, a stiffness k and a damping lambda. At n = 1 this is a linear spring whose
/// damping grows with depth.
struct WallLaw {
  double stiffness = 800;     ///< k [N/m]: F = k x0 at depth x0
  double damping = 0;         ///< lambda [N s/m]: the damping force at depth x0 is lambda v
  double exponent = 1;        ///< n, without unit
  double depth_scale = 1e-3;  ///< x0 [m] depth at which the force is k x0
};

struct WallForce {
  double force = 0;  ///< [N] force along the outward normal; never negative, because a wall does not pull
  /// [N/m] dF/dx at this speed, before a negative force is set to 0; for n < 1 it grows without bound toward depth 0
  double stiffness = 0;
  double damping = 0;  ///< [N s/m] dF/dv, before a negative force is set to 0
};

/// [rt] Returns the force at `depth` x [m] (> 0 inside) and `closing_speed` v [m/s] (> 0 if the probe goes deeper).
/// Both are relative to the wall, so the force is the same in every inertial frame. The force is zero for x <= 0 and
/// begins at zero for every speed.
WallForce wallForce(const WallLaw& law, double depth, double closing_speed) noexcept;

/// [any] Returns the slope dF/dx [N/m] of the elastic force k x0 (x/x0)^n at the depth where this force is `force` [N].
/// For n >= 1 this is the greatest slope up to this force. For n < 1 the slope is unbounded at depth 0, and the
/// function returns the slope at depth x0.
double wallSlopeAt(const WallLaw& law, double force) noexcept;

/// [any] Returns the depth [m] at which the elastic force is `force` [N]; infinite if there is no such depth.
double wallDepthAt(const WallLaw& law, double force) noexcept;

/// [any] Returns the energy [J] that is stored at `depth` [m]: the integral of the elastic force.
double wallEnergy(const WallLaw& law, double depth) noexcept;

}  // namespace hapticd::contact
