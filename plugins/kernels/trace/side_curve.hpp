// SPDX-License-Identifier: MIT
/// One side of a patch as a curve.
#pragma once
#include "kernels/trace/patch.hpp"

namespace hapticd::trace {

/// [any] Point at `fraction` (0..1) of a side.
Eigen::Vector3d pointOnSide(const Patch& patch, int side, double fraction) noexcept;
/// [any] Fraction (0..1) of the point of a side nearest to p, by safeguarded Newton from `start`; bounded work.
double nearestFraction(const Patch& patch, int side, const Eigen::Vector3d& p, double start) noexcept;
/// [main] The directions in which a patch leaves the pole that its side has shrunk to.
PoleFan fanOf(const Patch& patch, int side) noexcept;
/// [main] Sum over the fan of normal times angle [rad]: the pole's share of its vertex normal.
Eigen::Vector3d fanNormal(const Patch& patch, int side, const PoleFan& fan) noexcept;
/// [main] Interior angle [rad] of a patch at a corner between sides that are no poles.
double cornerAngle(const Patch& patch, int corner) noexcept;

}  // namespace hapticd::trace
