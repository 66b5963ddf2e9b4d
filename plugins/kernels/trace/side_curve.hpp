// SPDX-License-Identifier: MIT
/// One side of a patch as a curve.
#pragma once
#include "kernels/trace/patch.hpp"

namespace hapticd::trace {

/// [any] Returns the point at `fraction` (0 to 1) along a side.
Eigen::Vector3d pointOnSide(const Patch& patch, int side, double fraction) noexcept;
/// [any] Returns the fraction (0 to 1) along a side of its point nearest to p, by a safeguarded Newton's method from
/// `start` with a bounded number of steps.
double nearestFraction(const Patch& patch, int side, const Eigen::Vector3d& p, double start) noexcept;
/// [main] Returns the directions in which a patch leaves its pole. @param side the side that has shrunk to a point
PoleFan fanOf(const Patch& patch, int side) noexcept;
/// [main] Returns the sum over the fan of normal times angle [rad]. This is the contribution of the patch to the normal
/// of the vertex at the pole.
Eigen::Vector3d fanNormal(const Patch& patch, int side, const PoleFan& fan) noexcept;
/// [main] Returns the interior angle [rad] of a patch at a corner. Neither side at the corner may be a pole.
double cornerAngle(const Patch& patch, int corner) noexcept;

}  // namespace hapticd::trace
