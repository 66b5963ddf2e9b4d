// SPDX-License-Identifier: MIT
/// Converts curves of Open CASCADE to records of a part, with the same parameters.
#pragma once
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <gp_XYZ.hxx>
#include <numbers>
#include <stdexcept>

#include "kernels/part/part.hpp"

namespace hapticd::cad {

/// Metres per length unit of Open CASCADE.
inline constexpr double kMetres = 1e-3;

inline constexpr double kFullTurn = 2 * std::numbers::pi;  ///< [rad]

/// The reason why a face or a curve cannot be kept. In the report, the name of the face stands in front of this text.
struct Unkept : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The record that was added, and how much accuracy was lost.
struct Kept {
  std::uint32_t index = brep::kNone;
  double error = 0;  ///< 0 if nothing was approximated; for curves in space and surfaces in m, for pcurves in units of
                     ///< the parameters
};

/// [main] Appends a curve. A curve that is not a line, circle, ellipse or spline is approximated over [t0, t1]. @throws
/// Unkept
Kept addCurve(const Handle(Geom_Curve) & curve, double t0, double t1, brep::Part& part);

/// [main] Does the same as addCurve() for a curve in the parameter plane of a surface (a pcurve). @throws Unkept
Kept addPlaneCurve(const Handle(Geom2d_Curve) & curve, double t0, double t1, brep::Part& part);

/// [main] Converts a point or vector from millimetres to metres.
brep::Vector metres(const gp_XYZ& v);

}  // namespace hapticd::cad
