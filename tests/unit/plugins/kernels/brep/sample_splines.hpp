// SPDX-License-Identifier: MIT
/// Parts of untrimmed spline surfaces. Each surface is a face with four edges of its own.
#pragma once
#include "kernels/spline/surface_data.hpp"
#include "sample_parts.hpp"

namespace hapticd::brep::samples {

inline std::uint64_t addReals(Part& part, const std::vector<double>& reals) {
  const std::uint64_t first = part.reals.size();
  part.reals.insert(part.reals.end(), reals.begin(), reals.end());
  return first;
}

/// Adds one side of a clamped surface as an edge, and returns its index. @param at_end true for the side at the high
/// end of `axis`, false for the low end
inline std::uint32_t addSideEdge(Part& part, const spline::SurfaceData& data, int axis, bool at_end) {
  const auto along = static_cast<std::size_t>(1 - axis);
  const int count = data.count(1 - axis), place = at_end ? data.count(axis) - 1 : 0;
  Curve3 curve;
  curve.kind = CurveKind::kSpline;
  curve.degree = static_cast<std::uint32_t>(data.degree[along]);
  curve.count = static_cast<std::uint32_t>(count);
  curve.data = addReals(part, data.knots[along]);
  std::vector<double> weights;
  double length = 0;
  for (int i = 0; i < count; ++i) {
    const std::size_t at = static_cast<std::size_t>(axis == 0 ? place * data.count(1) + i : i * data.count(1) + place);
    const Eigen::Vector3d& p = data.points[at];
    addReals(part, {p.x(), p.y(), p.z()});
    if (!data.weights.empty()) weights.push_back(data.weights[at]);
    if (i > 0) length += (p - data.points[static_cast<std::size_t>(axis == 0 ? place * data.count(1) : place)]).norm();
  }
  if (!weights.empty()) {
    addReals(part, weights);
    curve.flags = kRational;
  }
  const auto domain = data.domain(1 - axis);
  const std::uint32_t v0 = addVertex(
      part, {part.reals[curve.data + data.knots[along].size()], part.reals[curve.data + data.knots[along].size() + 1],
             part.reals[curve.data + data.knots[along].size() + 2]});
  if (length > 1e-12) return addEdge(part, curve, domain[0], domain[1], v0, v0);
  Edge pole;
  pole.kind = EdgeKind::kPole;
  pole.first_vertex = pole.last_vertex = v0;
  pole.t0 = domain[0];
  pole.t1 = domain[1];
  part.edges.push_back(pole);
  return last(part.edges);
}

inline void addSplineFace(Part& part, const spline::SurfaceData& data) {
  Surface surface;
  surface.kind = SurfaceKind::kSpline;
  surface.flags = data.weights.empty() ? 0 : kRational;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    surface.degree[axis] = static_cast<std::uint32_t>(data.degree[axis]);
    surface.count[axis] = static_cast<std::uint32_t>(data.count(static_cast<int>(axis)));
  }
  surface.data = addReals(part, data.knots[0]);
  addReals(part, data.knots[1]);
  for (const Eigen::Vector3d& p : data.points) addReals(part, {p.x(), p.y(), p.z()});
  addReals(part, data.weights);
  const auto u = data.domain(0), v = data.domain(1);
  addFace(part, surface, data.reversed ? kReversed : 0, {u[0], v[0]}, {u[1], v[1]});
  addLoop(part);
  const auto side = [&](int axis, bool at_end, const Curve2& line, std::uint32_t flags) {
    const std::uint32_t edge = addSideEdge(part, data, axis, at_end);
    addCoedge(part, edge, line, flags | (part.edges[edge].kind == EdgeKind::kPole ? kDegenerate : 0));
  };
  side(1, false, line2({0, v[0]}, {1, 0}), 0);
  side(0, true, line2({u[1], 0}, {0, 1}), 0);
  side(1, true, line2({0, v[1]}, {1, 0}), kReversed);
  side(0, false, line2({u[0], 0}, {0, 1}), kReversed);
}

/// Returns a sheet of loose faces. The surfaces must be clamped.
inline Part sheetOf(const std::vector<spline::SurfaceData>& surfaces) {
  Part part;
  for (const spline::SurfaceData& data : surfaces) addSplineFace(part, data);
  endBody(part, BodyKind::kSheet, 0);
  return part;
}

}  // namespace hapticd::brep::samples
