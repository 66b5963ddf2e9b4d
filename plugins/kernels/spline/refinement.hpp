// SPDX-License-Identifier: MIT
/// The same curve or surface with more knots, as Bezier pieces, or in smooth parts. Parameters never change.
#pragma once
#include <span>
#include <vector>

#include "kernels/spline/curve_data.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// [rad] Surface normals that differ by less across a knot of full multiplicity are one smooth surface. The spans of an
/// exact circle or sphere join so; their normals agree to rounding, 1e-15.
inline constexpr double kSmoothAngle = 1e-6;

/// [main] Inserts knots inside the domain, each as often as it stands in `added`, at most to multiplicity `degree`.
/// The shape stays the same. @throws std::invalid_argument if the data are invalid or a knot lies outside the domain.
CurveData refine(const CurveData& curve, std::span<const double> added);
SurfaceData refine(const SurfaceData& surface, int axis, std::span<const double> added);

/// [main] The piece of a curve or surface between lo and hi, clamped, with the parameters of the whole.
/// @throws std::invalid_argument if the data are invalid or the range is empty or leaves the domain.
CurveData cut(const CurveData& curve, double lo, double hi);
SurfaceData cut(const SurfaceData& surface, int axis, double lo, double hi);

/// [main] One Bezier piece a span, in the order of the parameters (u-major for surfaces), each on its own range.
std::vector<CurveData> bezierPieces(const CurveData& curve);
std::vector<SurfaceData> bezierPieces(const SurfaceData& surface);

/// [main] Parts a surface at its gaps (knots of multiplicity degree + 1) and creases (multiplicity degree, where the
/// normals of both sides differ by more than `smooth_angle` [rad] somewhere or the surface turns back). Each part
/// keeps the parameters of the whole: its range is its domain(). u-major order.
std::vector<SurfaceData> splitAtCreases(const SurfaceData& surface, double smooth_angle = kSmoothAngle);

}  // namespace hapticd::spline
