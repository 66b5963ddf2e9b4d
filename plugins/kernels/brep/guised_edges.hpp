// SPDX-License-Identifier: MIT
/// Splines that are in truth lines or circles, as many CAD programs write them. Their feet have a closed form, which is
/// proved to be the nearest from wherever the probe looks; the parameter of the spline is what the faces beside know.
#pragma once
#include <optional>
#include <vector>

#include "kernels/brep/elements.hpp"
#include "kernels/brep/geometry.hpp"

namespace hapticd::brep {

struct GuisedEdge {
  EdgeShape shape;  ///< t0 and t1 count radians of a circle, metres of a line
  bool is_circle = false;
  std::uint32_t curve = 0;
  std::vector<double> stops;       ///< rising values of the shape's parameter, from shape.t0 to shape.t1
  std::vector<double> parameters;  ///< t of the spline there
};

/// [main] The line or circle that a spline edge is to within 5e-13 m; none if it is neither.
std::optional<GuisedEdge> unguised(const Geometry& geometry, const Edge& edge);

/// [rt] The spline's t at a point that lies on it, where the shape's parameter is s.
double parameterAt(const Geometry& geometry, const GuisedEdge& edge, double s, const Eigen::Vector3d& point) noexcept;

}  // namespace hapticd::brep
