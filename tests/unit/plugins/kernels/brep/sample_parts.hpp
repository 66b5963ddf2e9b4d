// SPDX-License-Identifier: MIT
/// Small parts made by hand, for tests. The parameters of planes and axes are in millimetres, as in CAD files.
#pragma once
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

#include "kernels/part/part.hpp"

namespace hapticd::brep::samples {

inline constexpr double kMm = 1e-3;  ///< [m]

inline std::uint32_t last(const auto& records) {
  return static_cast<std::uint32_t>(records.size()) - 1;
}

inline Vector scaled(const Vector& v, double by) {
  return {v[0] * by, v[1] * by, v[2] * by};
}
inline Vector sum(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

inline std::uint32_t addVertex(Part& part, const Vector& point) {
  part.vertices.push_back({point, 1e-9});
  return last(part.vertices);
}

inline std::uint32_t addEdge(Part& part, const Curve3& curve, double t0, double t1, std::uint32_t v0,
                             std::uint32_t v1) {
  part.curves3.push_back(curve);
  Edge edge;
  edge.curve = last(part.curves3);
  edge.first_vertex = v0;
  edge.last_vertex = v1;
  edge.t0 = t0;
  edge.t1 = t1;
  part.edges.push_back(edge);
  return last(part.edges);
}

/// Adds a coedge with a pcurve that is a line o + t x or a circle o + cos t x + sin t y.
inline void addCoedge(Part& part, std::uint32_t edge, const Curve2& pcurve, std::uint32_t flags) {
  part.curves2.push_back(pcurve);
  Coedge coedge;
  coedge.edge = edge;
  coedge.face = last(part.faces);
  coedge.pcurve = last(part.curves2);
  coedge.flags = flags;
  coedge.t0 = part.edges[edge].t0;
  coedge.t1 = part.edges[edge].t1;
  part.coedges.push_back(coedge);
  ++part.loops.back().count;
}

inline Curve2 line2(Vector2 o, Vector2 x) {
  Curve2 curve;
  curve.o = o;
  curve.x = x;
  return curve;
}
inline Curve2 circle2(Vector2 o, Vector2 x, Vector2 y) {
  Curve2 curve;
  curve.kind = CurveKind::kCircle;
  curve.o = o;
  curve.x = x;
  curve.y = y;
  return curve;
}

inline void addFace(Part& part, const Surface& surface, std::uint32_t flags, Vector2 lo, Vector2 hi) {
  part.surfaces.push_back(surface);
  Face face;
  face.surface = last(part.surfaces);
  face.first_loop = static_cast<std::uint32_t>(part.loops.size());
  face.flags = flags;
  face.body = static_cast<std::uint32_t>(part.bodies.size());  // endBody() adds this body
  face.lo = lo;
  face.hi = hi;
  part.faces.push_back(face);
}

inline void addLoop(Part& part) {
  part.loops.push_back({static_cast<std::uint32_t>(part.coedges.size()), 0});
  ++part.faces.back().loop_count;
}

/// Makes a body of all records that were added since the last body.
inline void endBody(Part& part, BodyKind kind, std::uint32_t flags) {
  Body body;
  if (!part.bodies.empty()) {
    const Body& before = part.bodies.back();
    body.first_face = before.first_face + before.face_count;
    body.first_edge = before.first_edge + before.edge_count;
    body.first_vertex = before.first_vertex + before.vertex_count;
    body.first_point = before.first_point + before.point_count;
    body.first_triangle = before.first_triangle + before.triangle_count;
  }
  body.kind = kind;
  body.flags = flags;
  body.face_count = static_cast<std::uint32_t>(part.faces.size()) - body.first_face;
  body.edge_count = static_cast<std::uint32_t>(part.edges.size()) - body.first_edge;
  body.vertex_count = static_cast<std::uint32_t>(part.vertices.size()) - body.first_vertex;
  body.point_count = static_cast<std::uint32_t>(part.points.size()) - body.first_point;
  body.triangle_count = static_cast<std::uint32_t>(part.triangles.size()) - body.first_triangle;
  part.bodies.push_back(body);
  Instance instance;
  instance.body = last(part.bodies);
  part.instances.push_back(instance);
  linkCoedges(part);
}

/// Returns a cylinder of radius r [mm] about z, whose parameters are the angle and z in mm.
inline Surface cylinderWall(double r) {
  Surface wall;
  wall.kind = SurfaceKind::kCylinder;
  wall.x = {1, 0, 0};
  wall.y = {0, 1, 0};
  wall.z = {0, 0, kMm};
  wall.r = {r * kMm, 0};
  wall.period = {2 * std::numbers::pi, 0};
  return wall;
}

/// Returns a solid cylinder of radius r [mm] about z, from z = 0 to z = h [mm], with one seam and two caps.
inline Part cappedCylinder(double r, double h) {
  constexpr double kTurn = 2 * std::numbers::pi;
  Part part;
  const std::uint32_t bottom = addVertex(part, {r * kMm, 0, 0}), top = addVertex(part, {r * kMm, 0, h * kMm});
  Curve3 circle;
  circle.kind = CurveKind::kCircle;
  circle.x = {r * kMm, 0, 0};
  circle.y = {0, r * kMm, 0};
  const std::uint32_t below = addEdge(part, circle, 0, kTurn, bottom, bottom);
  circle.o = {0, 0, h * kMm};
  const std::uint32_t above = addEdge(part, circle, 0, kTurn, top, top);
  Curve3 line;
  line.o = {r * kMm, 0, 0};
  line.x = {0, 0, kMm};
  const std::uint32_t seam = addEdge(part, line, 0, h, bottom, top);

  addFace(part, cylinderWall(r), 0, {0, 0}, {kTurn, h});
  addLoop(part);
  addCoedge(part, below, line2({0, 0}, {1, 0}), 0);
  addCoedge(part, seam, line2({kTurn, 0}, {0, 1}), kSeam);
  addCoedge(part, above, line2({0, h}, {1, 0}), kReversed);
  addCoedge(part, seam, line2({0, 0}, {0, 1}), kReversed | kSeam);

  Surface cap;
  cap.x = {kMm, 0, 0};
  cap.y = {0, kMm, 0};
  addFace(part, cap, kReversed, {-r, -r}, {r, r});
  addLoop(part);
  addCoedge(part, below, circle2({0, 0}, {r, 0}, {0, r}), 0);
  cap.o = {0, 0, h * kMm};
  addFace(part, cap, 0, {-r, -r}, {r, r});
  addLoop(part);
  addCoedge(part, above, circle2({0, 0}, {r, 0}, {0, r}), 0);
  endBody(part, BodyKind::kSolid, kClosed);
  return part;
}

}  // namespace hapticd::brep::samples
