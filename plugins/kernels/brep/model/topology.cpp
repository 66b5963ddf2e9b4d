// SPDX-License-Identifier: MIT
#include "kernels/brep/model/topology.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hapticd::brep {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSmooth = 0.1 * std::numbers::pi / 180;  ///< [rad] an edge is smooth if the normals differ by less

double angleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// How the two faces of an edge meet at one point.
struct Meeting {
  double angle = 0;
  bool convex = false;
};

Meeting meetingAt(const Geometry& geometry, const Edge& edge, double t) {
  const Part& part = geometry.part();
  const Coedge& a = part.coedges[edge.first_coedge];
  const Coedge& b = part.coedges[a.next];
  const Vector3d n1 = coedgeNormal(geometry, a, t), n2 = coedgeNormal(geometry, b, t);
  spline::CurvePoint C;
  geometry.curve(edge.curve, t, C);
  // n x T points into face a if T runs along its loop. On a reversed face the loop runs clockwise, seen from outside.
  const bool against = ((a.flags & kReversed) != 0) != ((part.faces[a.face].flags & kReversed) != 0);
  const Vector3d into = n1.cross(against ? Vector3d(-C.C1) : C.C1);
  return {angleBetween(n1, n2), into.dot(n2) < 0};
}

void classify(const Geometry& geometry, Edge& edge) {
  constexpr int kPoints = 9;
  if (edge.curve == kNone) {
    edge.kind = EdgeKind::kPole;
    return;
  }
  if (edge.coedge_count != 2) {
    edge.kind = edge.coedge_count < 2 ? EdgeKind::kFree : EdgeKind::kNonManifold;
    return;
  }
  bool convex = false, concave = false;
  edge.angle = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Meeting m = meetingAt(geometry, edge, edge.t0 + (edge.t1 - edge.t0) * (i + 0.5) / kPoints);
    edge.angle = std::max(edge.angle, m.angle);
    if (m.angle < kSmooth) continue;
    (m.convex ? convex : concave) = true;
  }
  edge.kind = convex && concave ? EdgeKind::kMixed
              : convex          ? EdgeKind::kConvex
              : concave         ? EdgeKind::kConcave
                                : EdgeKind::kSmooth;
}

/// Returns the direction of a coedge in space at one of its ends, in the direction of its loop.
Vector3d tangentAt(const Geometry& geometry, const Coedge& c, bool at_end) {
  const bool reversed = (c.flags & kReversed) != 0;
  const double inward = 1e-6 * (c.t1 - c.t0);  // the derivative of a spline may be 0 at its very ends
  const double t = at_end != reversed ? c.t1 - inward : c.t0 + inward;
  spline::CurvePoint C;
  geometry.curve(geometry.part().edges[c.edge].curve, t, C);
  return reversed ? Vector3d(-C.C1) : C.C1;
}

class VertexSums {
 public:
  explicit VertexSums(const Geometry& geometry)
      : geometry_(geometry),
        part_(geometry.part()),
        sums_(part_.vertices.size(), Vector3d::Zero()),
        open_(part_.vertices.size(), 0) {}

  std::vector<CornerNormal> run() {
    for (const Edge& edge : part_.edges)
      if (edge.kind == EdgeKind::kFree)
        for (const std::uint32_t v : {edge.first_vertex, edge.last_vertex})
          if (v != kNone) open_[v] = 1;
    for (const Face& face : part_.faces)
      for (std::uint32_t i = 0; i < face.loop_count; ++i) addLoop(part_.loops[face.first_loop + i]);
    std::vector<CornerNormal> normals(sums_.size());
    for (std::size_t v = 0; v < sums_.size(); ++v) {
      const double length = sums_[v].norm();
      if (length > 0) normals[v].normal = (sums_[v] / length).cast<float>();
      normals[v].open = open_[v] != 0;
    }
    return normals;
  }

 private:
  std::uint32_t startVertex(const Coedge& c) const {
    const Edge& e = part_.edges[c.edge];
    return (c.flags & kReversed) != 0 ? e.last_vertex : e.first_vertex;
  }

  void addLoop(const Loop& loop) {
    for (std::uint32_t i = 0; i < loop.count; ++i) {
      const Coedge& out = part_.coedges[loop.first + i];
      const Coedge& in = part_.coedges[loop.first + (i + loop.count - 1) % loop.count];
      const std::uint32_t vertex = startVertex(out);
      if (vertex == kNone) continue;
      if ((out.flags & kDegenerate) != 0)
        addPole(out, vertex);
      else if ((in.flags & kDegenerate) == 0)
        addCorner(in, out, vertex);
    }
  }

  /// Adds a face's normal at a corner, weighted by the angle of the face there. The angle is counted counter-clockwise
  /// about the normal Su x Sv from the outgoing coedge.
  void addCorner(const Coedge& in, const Coedge& out, std::uint32_t vertex) {
    const double t = (out.flags & kReversed) != 0 ? out.t1 : out.t0;
    const Vector3d n = coedgeNormal(geometry_, out, t);
    const bool reversed = (part_.faces[out.face].flags & kReversed) != 0;
    const Vector3d away = tangentAt(geometry_, out, false), back = -tangentAt(geometry_, in, true);
    const Vector3d own = reversed ? Vector3d(-n) : n;
    double angle = std::atan2(own.dot(away.cross(back)), away.dot(back));
    if (angle < 0) angle += 2 * std::numbers::pi;
    if (std::isfinite(angle)) sums_[vertex] += angle * n;
  }

  /// Adds the normals around a pole, where each meridian has its own normal. The normals along the collapsed side of
  /// the face are added with equal weights, so that their sum is along the axis.
  void addPole(const Coedge& c, std::uint32_t vertex) {
    constexpr int kRays = 16;
    for (int i = 0; i < kRays; ++i)
      sums_[vertex] += std::numbers::pi / kRays * coedgeNormal(geometry_, c, c.t0 + (c.t1 - c.t0) * (i + 0.5) / kRays);
  }

  const Geometry& geometry_;
  const Part& part_;
  std::vector<Vector3d> sums_;
  std::vector<char> open_;
};

}  // namespace

Vector3d coedgeNormal(const Geometry& geometry, const Coedge& coedge, double t) noexcept {
  const Face& face = geometry.part().faces[coedge.face];
  const Vector2d uv = geometry.planeCurve(coedge.pcurve, t).c;
  const Vector3d n = geometry.normal(face, uv);
  return (face.flags & kReversed) != 0 ? Vector3d(-n) : n;
}

void classifyEdges(const Geometry& geometry, std::vector<Edge>& edges) {
  for (Edge& edge : edges)
    if (edge.kind == EdgeKind::kUnknown) classify(geometry, edge);
}

std::vector<CornerNormal> vertexNormals(const Geometry& geometry) {
  return VertexSums(geometry).run();
}

}  // namespace hapticd::brep
