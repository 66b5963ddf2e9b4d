// SPDX-License-Identifier: MIT
/// Knot lines at which a surface has a cusp: rows of control points coincide there, so the tangent across vanishes and
/// the surface may turn sharply, although the knot is simple. Modellers make sharp edges in this way.
#pragma once
#include <vector>

#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// [main] Returns the knots, ends of the domain included, at which all control points that count coincide on some line
/// of control points along the axis.
std::vector<double> cuspKnots(const SurfaceData& data, int axis);

/// [main] If one row of control points at the end of a piece is apart and all others coincide, the piece runs straight
/// from row to row, but as the power `degree` of the parameter: Newton's method would take its first row for a foot
/// wherever the probe is. Spaces the rows evenly. The shape stays the same; the parameter inside the piece does not.
/// @param piece one span along the axis, clamped
void straighten(SurfaceData& piece, int axis);

/// [main] True if all rows of control points along the axis coincide, so that the piece is no more than a line.
bool isOnlyALine(const SurfaceData& piece, int axis);

}  // namespace hapticd::spline
