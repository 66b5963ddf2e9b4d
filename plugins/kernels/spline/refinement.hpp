// SPDX-License-Identifier: MIT
/// Rewrites a curve or surface with more knots, as Bezier pieces, or as smooth parts. The shape and its parameters do
/// not change.
#pragma once
#include <span>
#include <vector>

#include "kernels/spline/curve_data.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// [rad] A surface counts as smooth across a knot of multiplicity `degree` if its normals on both sides differ by less
/// than this. The spans of an exact circle or sphere meet at such knots, and their normals agree to 1e-15.
inline constexpr double kSmoothAngle = 1e-6;

/// [main] Inserts the knots `added`, which must be inside the domain. A knot that occurs several times is inserted as
/// often, but its multiplicity does not rise above `degree`. The shape stays the same. @throws std::invalid_argument if
/// the data are invalid or a knot lies outside the domain.
CurveData refine(const CurveData& curve, std::span<const double> added);
SurfaceData refine(const SurfaceData& surface, int axis, std::span<const double> added);

/// [main] Returns the piece of a curve or surface between lo and hi, clamped, with unchanged parameters.
/// @throws std::invalid_argument if the data are invalid or the range is empty or leaves the domain.
CurveData cut(const CurveData& curve, double lo, double hi);
SurfaceData cut(const SurfaceData& surface, int axis, double lo, double hi);

/// [main] Returns one Bezier piece per span, in the order of the parameters (u-major for surfaces). Each piece keeps
/// its parameter range.
std::vector<CurveData> bezierPieces(const CurveData& curve);
std::vector<SurfaceData> bezierPieces(const SurfaceData& surface);

/// [main] Splits a surface at its gaps (knots of multiplicity degree + 1), at its creases, and at its cusps and one
/// span beside them (see cusp.hpp). A crease is a knot of multiplicity `degree` where somewhere the normals of both
/// sides differ by more than `smooth_angle` [rad] or the surface folds back. Each part keeps its parameters, so its
/// domain() is its range in the whole surface, but in a span beside a cusp they may run otherwise: there the parts are
/// rewritten so that no tangent vanishes (see cusp.hpp and grading.hpp). This moves no point by more than 1e-8 of the
/// part. Parts that are only lines are left out. The parts are in u-major order.
std::vector<SurfaceData> splitAtCreases(const SurfaceData& surface, double smooth_angle = kSmoothAngle);

/// [main] True if the surface has a cusp beside which splitAtCreases() cannot make each part regular.
bool hasDoubtfulCusp(const SurfaceData& surface);

}  // namespace hapticd::spline
