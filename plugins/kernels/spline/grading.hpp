// SPDX-License-Identifier: MIT
/// Changes the parameter of a surface whose speed varies by orders of magnitude, as beside a cusp, so that Newton's
/// method can step through it.
#pragma once
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// [main] Rewrites a piece so that its points move across its rows at nearly the same speed everywhere along the axis.
/// The parameter becomes a quadratic spline of the new one (piecewise composition of Bezier patches, DeRose 1988), so
/// the shape stays the same and the degree doubles. A strip that is narrower than 1e-9 of the piece is made straight:
/// in it the speed may vanish.
/// @param piece one span along the axis, clamped. It stays as it is if its speed varies little, or if twice its degree
/// is above kMaxDegree.
/// @return false if the speed varies too much and the piece stayed as it is
bool grade(SurfaceData& piece, int axis);

}  // namespace hapticd::spline
