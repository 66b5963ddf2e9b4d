// SPDX-License-Identifier: MIT
/// Recognised edges: edges that the file stores as splines, but that are lines or circles to rounding. Many CAD
/// programs write them so (CAD systems call this step canonical recognition). The foot on a line or circle has a closed
/// form, which is the nearest point for every probe. The faces beside such an edge still need the parameter of the
/// spline.
#pragma once
#include <optional>
#include <vector>

#include "kernels/brep/elements/elements.hpp"
#include "kernels/brep/geometry/geometry.hpp"

namespace hapticd::brep {

struct RecognisedEdge {
  EdgeShape shape;  ///< its t0 and t1 are in rad for a circle, in m for a line
  bool is_circle = false;
  std::uint32_t curve = 0;
  std::vector<double> stops;       ///< increasing values of the shape's parameter, from shape.t0 to shape.t1
  std::vector<double> parameters;  ///< parameter t of the spline at each of the stops
};

/// [main] Returns the line or circle from which a spline edge deviates by at most 5e-13 m, or nothing if there is none.
std::optional<RecognisedEdge> recogniseEdge(const Geometry& geometry, const Edge& edge);

/// [rt] Returns the spline's parameter t at `point`, which lies on the spline and has the parameter s on the shape.
double parameterAt(const Geometry& geometry, const RecognisedEdge& edge, double s,
                   const Eigen::Vector3d& point) noexcept;

}  // namespace hapticd::brep
