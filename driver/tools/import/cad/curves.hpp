// SPDX-License-Identifier: MIT
/// Curves of Open CASCADE to records of a part, in their own parameters.
#pragma once
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <gp_XYZ.hxx>
#include <numbers>
#include <stdexcept>

#include "kernels/brep/part.hpp"

namespace hapticd::cad {

/// Metres per length unit of Open CASCADE.
inline constexpr double kMetres = 1e-3;

inline constexpr double kFullTurn = 2 * std::numbers::pi;  ///< [rad]

/// Why a face or a curve cannot be kept; the text follows its name.
struct Unkept : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// How much accuracy a record lost: 0 if nothing was approximated.
struct Kept {
  std::uint32_t index = brep::kNone;
  double error = 0;  ///< [m] of curves in space and of surfaces; in parameters for pcurves
};

/// [main] Appends a curve; what is not a line, circle, ellipse or spline is approximated over [t0, t1]. @throws Unkept
Kept addCurve(const Handle(Geom_Curve) & curve, double t0, double t1, brep::Part& part);

/// [main] The same in the parameters of a surface. @throws Unkept
Kept addPlaneCurve(const Handle(Geom2d_Curve) & curve, double t0, double t1, brep::Part& part);

/// [main] A point or direction in metres.
brep::Vector metres(const gp_XYZ& v);

}  // namespace hapticd::cad
