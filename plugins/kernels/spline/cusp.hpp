// SPDX-License-Identifier: MIT
/// Knot lines at which a surface has a cusp: rows of control points coincide there, so the tangent across vanishes and
/// the surface may turn sharply, although the knot is simple. Modellers make sharp edges in this way.
#pragma once
#include <vector>

#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// [main] Returns the knots, ends of the domain included, at which all control points that count coincide on some line
/// of control points along the axis, or nearly coincide on all lines.
std::vector<double> cuspKnots(const SurfaceData& data, int axis);

/// [main] True if the weights of each row along the axis are the same multiple of those of the first row, or there are
/// none.
bool weightsAreAlike(const SurfaceData& data, int axis);

/// [main] If one row of control points at the end of a piece is apart and all others coincide, the piece runs straight
/// from row to row, but as the power `degree` of the parameter: Newton's method would take its first row for a foot
/// wherever the probe is. Spaces the rows evenly. The shape stays the same; the parameters inside the piece do not.
/// If the weights of a row are no multiple of those of another, this is only so for flat quadrilaterals.
/// @param piece one span along the axis, clamped
/// @return false if the piece has another form, or its shape would change; then it stays as it is
bool straighten(SurfaceData& piece, int axis);

/// [main] True if the control points of a piece lie in a flat and convex quadrilateral, and those of its sides on the
/// edges. Then the piece covers that quadrilateral, whatever its weights are. @param piece clamped along both axes
bool isFlatQuad(const SurfaceData& piece);

/// [main] Replaces a piece by the bilinear one with the same corners. @param piece clamped along both axes
void makeBilinear(SurfaceData& piece);

/// [main] True if all rows of control points along the axis coincide, so that the piece is no more than a line.
bool isOnlyALine(const SurfaceData& piece, int axis);

}  // namespace hapticd::spline
