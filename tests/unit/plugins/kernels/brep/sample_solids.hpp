// SPDX-License-Identifier: MIT
/// More parts made by hand: prisms, plates with holes, cones, spheres, tori, spline sheets. Sizes in millimetres.
#pragma once
#include <Eigen/Geometry>
#include <map>

#include "sample_parts.hpp"

namespace hapticd::brep::samples {

using Eigen::Vector3d;

inline constexpr double kTurn = 2 * std::numbers::pi;

inline Vector toVector(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// Builds polyhedra: vertices and straight edges are shared by the polygons that name them.
class Polyhedron {
 public:
  Part part;

  /// Adds a polygon with holes. @param loops points [mm] of the outline, counter-clockwise seen from outside, then of
  /// the holes, clockwise
  void addPolygon(const std::vector<std::vector<Vector3d>>& loops) {
    const std::vector<Vector3d>& outer = loops[0];
    Vector3d n = Vector3d::Zero();
    for (std::size_t i = 0; i < outer.size(); ++i) n += outer[i].cross(outer[(i + 1) % outer.size()]);
    n.normalize();
    const Vector3d o = outer[0], x = (outer[1] - outer[0]).normalized(), y = n.cross(x);
    Surface plane;
    plane.o = scaled(toVector(o), kMm);
    plane.x = scaled(toVector(x), kMm);
    plane.y = scaled(toVector(y), kMm);
    Vector2 lo{1e9, 1e9}, hi{-1e9, -1e9};
    for (const Vector3d& p : outer) {
      const Vector2 uv{(p - o).dot(x), (p - o).dot(y)};
      for (std::size_t k = 0; k < 2; ++k) {
        lo[k] = std::min(lo[k], uv[k]);
        hi[k] = std::max(hi[k], uv[k]);
      }
    }
    addFace(part, plane, 0, lo, hi);
    for (const auto& loop : loops) {
      addLoop(part);
      for (std::size_t i = 0; i < loop.size(); ++i) addSide(loop[i], loop[(i + 1) % loop.size()], o, x, y);
    }
  }

 private:
  std::uint32_t vertexAt(const Vector3d& p) {
    const auto [found, added] = vertices_.try_emplace({p.x(), p.y(), p.z()}, 0);
    if (added) found->second = addVertex(part, scaled(toVector(p), kMm));
    return found->second;
  }

  void addSide(const Vector3d& a, const Vector3d& b, const Vector3d& o, const Vector3d& x, const Vector3d& y) {
    const std::uint32_t va = vertexAt(a), vb = vertexAt(b);
    const bool reversed = va > vb;
    const Vector3d from = reversed ? b : a, to = reversed ? a : b;
    const Vector3d way = (to - from).normalized();
    const auto [found, added] = edges_.try_emplace({std::min(va, vb), std::max(va, vb)}, 0);
    if (added) {
      Curve3 line;
      line.o = scaled(toVector(from), kMm);
      line.x = scaled(toVector(way), kMm);
      found->second = addEdge(part, line, 0, (to - from).norm(), std::min(va, vb), std::max(va, vb));
    }
    addCoedge(part, found->second, line2({(from - o).dot(x), (from - o).dot(y)}, {way.dot(x), way.dot(y)}),
              reversed ? kReversed : 0);
  }

  std::map<std::array<double, 3>, std::uint32_t> vertices_;
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> edges_;
};

/// Returns the prism over a counter-clockwise polygon of the xy plane, from z = 0 to h.
inline Part prism(const std::vector<std::array<double, 2>>& polygon, double h) {
  Polyhedron made;
  std::vector<Vector3d> top, bottom;
  for (const auto& p : polygon) {
    top.emplace_back(p[0], p[1], h);
    bottom.emplace_back(p[0], p[1], 0);
  }
  made.addPolygon({top});
  made.addPolygon({{bottom.rbegin(), bottom.rend()}});
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    made.addPolygon({{bottom[i], bottom[j], top[j], top[i]}});
  }
  endBody(made.part, BodyKind::kSolid, kClosed);
  return made.part;
}

/// Returns a concave bracket with two legs of 30 mm x 10 mm and a depth of 20 mm.
inline Part bracket() {
  return prism({{0, 0}, {30, 0}, {30, 10}, {10, 10}, {10, 30}, {0, 30}}, 20);
}

/// Returns a surface of revolution about z, whose axes x and y are those of the frame.
inline Surface aboutZ(SurfaceKind kind, double r0, double r1, double z_length, double o_z = 0) {
  Surface s;
  s.kind = kind;
  s.o = {0, 0, o_z * kMm};
  s.x = {1, 0, 0};
  s.y = {0, 1, 0};
  s.z = {0, 0, z_length};
  s.r = {r0, r1};
  s.period = {kTurn, kind == SurfaceKind::kTorus ? kTurn : 0};
  return s;
}

inline Curve3 circleAboutZ(double r, double z, Vector2 centre = {0, 0}) {
  Curve3 c;
  c.kind = CurveKind::kCircle;
  c.o = {centre[0] * kMm, centre[1] * kMm, z * kMm};
  c.x = {r * kMm, 0, 0};
  c.y = {0, r * kMm, 0};
  return c;
}

/// Adds an edge that is a single point, and its coedge along v = const from u = 0 to 2 pi.
inline void addPole(Part& part, std::uint32_t vertex, double v, std::uint32_t flags) {
  Edge pole;
  pole.kind = EdgeKind::kPole;
  pole.first_vertex = pole.last_vertex = vertex;
  part.edges.push_back(pole);
  addCoedge(part, last(part.edges), line2({0, v}, {1, 0}), kDegenerate | flags);
  part.coedges.back().t1 = kTurn;
}

/// Returns a sphere of radius r about the origin, with one seam and two poles.
inline Part sphere(double r) {
  constexpr double kQuarter = std::numbers::pi / 2;
  Part part;
  const std::uint32_t south = addVertex(part, {0, 0, -r * kMm}), north = addVertex(part, {0, 0, r * kMm});
  Curve3 meridian;
  meridian.kind = CurveKind::kCircle;
  meridian.x = {r * kMm, 0, 0};
  meridian.y = {0, 0, r * kMm};
  const std::uint32_t seam = addEdge(part, meridian, -kQuarter, kQuarter, south, north);
  addFace(part, aboutZ(SurfaceKind::kSphere, r * kMm, 0, 1), 0, {0, -kQuarter}, {kTurn, kQuarter});
  addLoop(part);
  addPole(part, south, -kQuarter, 0);
  addCoedge(part, seam, line2({kTurn, 0}, {0, 1}), kSeam);
  addPole(part, north, kQuarter, kReversed);
  addCoedge(part, seam, line2({0, 0}, {0, 1}), kSeam | kReversed);
  endBody(part, BodyKind::kSolid, kClosed);
  return part;
}

/// Returns a cone with its apex at the origin and its base of radius r at z = -h.
inline Part cone(double r, double h) {
  Part part;
  const double slant = std::hypot(r, h);
  const std::uint32_t apex = addVertex(part, {0, 0, 0}), rim = addVertex(part, {r * kMm, 0, -h * kMm});
  const std::uint32_t base = addEdge(part, circleAboutZ(r, -h), 0, kTurn, rim, rim);
  Curve3 line;
  line.o = {0, 0, 0};
  line.x = {r / slant * kMm, 0, -h / slant * kMm};
  const std::uint32_t seam = addEdge(part, line, 0, slant, apex, rim);
  Surface side = aboutZ(SurfaceKind::kCone, 0, -r / slant * kMm, h / slant * kMm);
  addFace(part, side, 0, {0, -slant}, {kTurn, 0});
  addLoop(part);
  // The parameter v runs from -slant at the rim to 0 at the apex; with r1 < 0 the radius there is positive.
  addCoedge(part, base, line2({0, -slant}, {1, 0}), 0);
  addCoedge(part, seam, line2({kTurn, 0}, {0, -1}), kSeam | kReversed);
  addPole(part, apex, 0, kReversed);
  addCoedge(part, seam, line2({0, 0}, {0, -1}), kSeam);
  Surface cap;
  cap.o = {0, 0, -h * kMm};
  cap.x = {kMm, 0, 0};
  cap.y = {0, kMm, 0};
  addFace(part, cap, kReversed, {-r, -r}, {r, r});
  addLoop(part);
  addCoedge(part, base, circle2({0, 0}, {r, 0}, {0, r}), 0);
  endBody(part, BodyKind::kSolid, kClosed);
  return part;
}

/// Returns a torus about z with two seams.
inline Part torus(double r0, double r1) {
  Part part;
  const std::uint32_t v = addVertex(part, {(r0 + r1) * kMm, 0, 0});
  const std::uint32_t around = addEdge(part, circleAboutZ(r0 + r1, 0), 0, kTurn, v, v);
  Curve3 tube;
  tube.kind = CurveKind::kCircle;
  tube.o = {r0 * kMm, 0, 0};
  tube.x = {r1 * kMm, 0, 0};
  tube.y = {0, 0, r1 * kMm};
  const std::uint32_t across = addEdge(part, tube, 0, kTurn, v, v);
  addFace(part, aboutZ(SurfaceKind::kTorus, r0 * kMm, r1 * kMm, 1), 0, {0, 0}, {kTurn, kTurn});
  addLoop(part);
  addCoedge(part, around, line2({0, 0}, {1, 0}), kSeam);
  addCoedge(part, across, line2({kTurn, 0}, {0, 1}), kSeam);
  addCoedge(part, around, line2({0, kTurn}, {1, 0}), kSeam | kReversed);
  addCoedge(part, across, line2({0, 0}, {0, 1}), kSeam | kReversed);
  endBody(part, BodyKind::kSolid, kClosed);
  return part;
}

/// A round hole through a plate: its circles below and above.
struct Hole {
  std::uint32_t below, above;
  Vector2 centre;
};

/// Adds the wall of a hole of radius r through a plate of thickness h.
inline Hole addHole(Part& part, Vector2 c, double r, double h) {
  const std::uint32_t v0 = addVertex(part, {(c[0] + r) * kMm, c[1] * kMm, 0});
  const std::uint32_t v1 = addVertex(part, {(c[0] + r) * kMm, c[1] * kMm, h * kMm});
  const std::uint32_t below = addEdge(part, circleAboutZ(r, 0, c), 0, kTurn, v0, v0);
  const std::uint32_t above = addEdge(part, circleAboutZ(r, h, c), 0, kTurn, v1, v1);
  Curve3 line;
  line.o = {(c[0] + r) * kMm, c[1] * kMm, 0};
  line.x = {0, 0, kMm};
  const std::uint32_t seam = addEdge(part, line, 0, h, v0, v1);
  Surface wall = aboutZ(SurfaceKind::kCylinder, r * kMm, 0, kMm);
  wall.o = {c[0] * kMm, c[1] * kMm, 0};
  addFace(part, wall, kReversed, {0, 0}, {kTurn, h});
  addLoop(part);
  addCoedge(part, below, line2({0, 0}, {1, 0}), 0);
  addCoedge(part, seam, line2({kTurn, 0}, {0, 1}), kSeam);
  addCoedge(part, above, line2({0, h}, {1, 0}), kReversed);
  addCoedge(part, seam, line2({0, 0}, {0, 1}), kSeam | kReversed);
  return {below, above, c};
}

/// Returns a plate of thickness h with columns x rows round holes of radius r. @param pitch distance between the
/// centres of neighbouring holes
inline Part plate(int columns, int rows, double r, double pitch, double h) {
  const double width = columns * pitch, depth = rows * pitch;
  Polyhedron made;
  const std::vector<Vector3d> bottom{{0, 0, 0}, {width, 0, 0}, {width, depth, 0}, {0, depth, 0}};
  std::vector<Vector3d> top = bottom;
  for (Vector3d& p : top) p.z() = h;
  for (std::size_t i = 0; i < 4; ++i) made.addPolygon({{bottom[i], bottom[(i + 1) % 4], top[(i + 1) % 4], top[i]}});
  Part& part = made.part;
  std::vector<Hole> holes;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) holes.push_back(addHole(part, {(i + 0.5) * pitch, (j + 0.5) * pitch}, r, h));
  made.addPolygon({{bottom[0], bottom[3], bottom[2], bottom[1]}});
  for (const Hole& hole : holes) {  // the axis x of this plane is along y of the plate
    addLoop(part);
    addCoedge(part, hole.below, circle2({hole.centre[1], hole.centre[0]}, {0, r}, {r, 0}), 0);
  }
  made.addPolygon({top});
  for (const Hole& hole : holes) {
    addLoop(part);
    addCoedge(part, hole.above, circle2(hole.centre, {r, 0}, {0, r}), kReversed);
  }
  endBody(part, BodyKind::kSolid, kClosed);
  return part;
}

}  // namespace hapticd::brep::samples
