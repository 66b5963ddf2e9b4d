// SPDX-License-Identifier: MIT
/// Moves the foot of a held contact over its face, and on over edges.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "kernels/brep/contact/next_faces.hpp"
#include "kernels/brep/contact/tracer.hpp"
#include "kernels/brep/geometry/triangle_foot.hpp"
#include "kernels/brep/model/narrow_triangles.hpp"
#include "kernels/brep/model/topology.hpp"
#include "kernels/contact/edge_rule.hpp"

namespace hapticd::brep {
namespace {

using contact::AtEdge;
using contact::Followed;
using contact::Foot;
using Eigen::Vector3d;

constexpr int kMaxCrossings = 6;       ///< most changes of faces over edges in one tick
constexpr int kMaxTriangles = 256;     ///< most triangles that a foot crosses in one tick
constexpr double kNearer = 1 - 1e-12;  ///< factor of a squared distance; a smaller difference counts as rounding error

bool isEdge(const Hit& hit) noexcept {
  return hit.element.kind() >= ElementKind::kLine && hit.element.kind() <= ElementKind::kPole;
}

/// Returns the unit vector in the tangent plane of a coedge's face that is at right angles to the edge and points out
/// of the face.
Vector3d outOf(const Geometry& geometry, const Coedge& coedge, double t, const Vector3d& normal) noexcept {
  const Part& part = geometry.part();
  spline::CurvePoint C;
  geometry.curve(part.edges[coedge.edge].curve, t, C);
  const bool against = ((coedge.flags & kReversed) != 0) != ((part.faces[coedge.face].flags & kReversed) != 0);
  const Vector3d along = against ? Vector3d(-C.C1) : C.C1;
  return along.cross(normal).stableNormalized();
}

void takeNearer(const Hit& hit, Hit& best) noexcept {
  if (hit.d2 < best.d2) best = hit;
}

/// Examines the triangles around a corner, beginning beyond edge k of `first`. @param after which edge is crossed next:
/// 1 for the edge that follows the crossed edge in its triangle, 0 for the edge before it. This gives the sense of
/// rotation about the corner
/// @param flat ends at the first edge over which the surface bends
void turnAbout(const Part& part, std::uint32_t first, std::uint32_t k, std::uint32_t after, bool flat,
               const Vector3d& p, Hit& best) noexcept {
  constexpr int kMostAround = 64;
  std::uint32_t at = first;
  for (int n = 0; n < kMostAround; ++n) {
    const std::uint32_t code = part.triangles[at].across[k];
    if (code == kNone || code / 4 == first || (flat && !isFlatOver(part, at, k))) return;
    at = code / 4;
    k = (code % 4 + (after == 1 ? 1 : 2)) % 3;
    takeNearer(footOn(part, at, p), best);
  }
}

/// Examines the triangles around corner k of a triangle. Those that the foot reaches without a bend come first:
/// together they are one face, whose walls must not catch a foot that passes beside them.
void lookAround(const Part& part, std::uint32_t triangle, std::uint32_t k, const Vector3d& p, Hit& best) noexcept {
  const Element before = best.element;
  for (const bool flat : {true, false}) {
    if (!(best.element == before)) return;
    turnAbout(part, triangle, k, 1, flat, p, best);
    turnAbout(part, triangle, (k + 2) % 3, 0, flat, p, best);
  }
}

/// Looks for a nearer foot beyond narrow triangles, at which a descent from triangle to triangle comes to a stand.
void passNarrow(const Part& part, std::uint32_t triangle, const Vector3d& p, Hit& best) noexcept {
  const double distance = (p - best.point).norm();
  const NearFoot near(part, triangle, best.point, distance);
  if (!near.hasNarrow()) return;
  const Vector3d here = triangleNormal(part, part.triangles[triangle]);
  const bool narrow = isNarrow(part, triangle, distance);
  if (narrow) best.d2 *= 1 / (kNearer * kNearer);  // a wide one that is as near is better
  for (std::size_t i = 1; i < near.count(); ++i)
    if (!near.narrow(i) && (narrow || looksAlong(part, near[i], here))) takeNearer(footOn(part, near[i], p), best);
}

/// Where a straight way over a triangle leaves it.
struct Exit {
  std::uint32_t edge = kNone;  ///< kNone if the way ends in the triangle
  Vector3d point{0, 0, 0};
};

/// Follows the way from a point of a triangle to the projection of p onto its plane.
/// @param entered edge through which the way has come in, or kNone
Exit exitOf(const Part& part, std::uint32_t triangle, std::uint32_t entered, const Vector3d& from,
            const Vector3d& p) noexcept {
  const auto& corner = part.triangles[triangle].corner;
  const Vector3d a = vec(part.points[corner[0]]);
  const Vector3d n = (vec(part.points[corner[1]]) - a).cross(vec(part.points[corner[2]]) - a);
  Exit exit;
  double share = 1;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const Vector3d start = vec(part.points[corner[k]]), end = vec(part.points[corner[(k + 1) % 3]]);
    const Vector3d out = (end - start).cross(n);
    const double inside = std::max(out.dot(start - from), 0.0), beyond = out.dot(p - start);
    if (k == entered || !(beyond > 0) || !(inside < share * (inside + beyond))) continue;
    share = inside / (inside + beyond);
    exit.edge = k;
  }
  if (exit.edge != kNone) exit.point = from + share * (p - n * (n.dot(p - a) / n.squaredNorm()) - from);
  return exit;
}

/// True if the probe has crossed the convex edge k of the held triangle and is in front of the next triangle.
bool isReleased(const Part& part, std::uint32_t triangle, const Vector3d& foot, std::uint32_t k, double side,
                const Vector3d& p) noexcept {
  const Triangle& t = part.triangles[triangle];
  if (t.across[k] == kNone) return false;
  const Vector3d here = triangleNormal(part, t);
  const double distance = (p - foot).norm();
  std::uint32_t next = t.across[k] / 4;
  if (isNarrow(part, next, distance) && !isNarrow(part, triangle, distance)) {
    const std::uint32_t wide = NearFoot(part, triangle, foot, distance).nextWide(part, triangle, here);
    if (wide != kNone) next = wide;
  }
  const Vector3d there = side * triangleNormal(part, part.triangles[next]);
  const Vector3d along = vec(part.points[t.corner[(k + 1) % 3]]) - vec(part.points[t.corner[k]]);
  const contact::EdgeKind kind = contact::edgeKind(side * here, there, along.cross(here).stableNormalized());
  return contact::atEdge(kind, there, p - foot) == AtEdge::kRelease;
}

}  // namespace

Followed Tracer::follow(double side, const Vector3d& p, Foot& foot) noexcept {
  if (held_.place == kNone) return Followed::kLost;
  const bool mesh = held_.hit.element.kind() == ElementKind::kTriangle;
  const std::uint32_t face = held_.face;
  const Followed how = mesh ? followTriangles(side, p) : followFace(side, p);
  if (how != Followed::kOn) return how;
  foot = describe(model(), held_.place, held_.hit, held_.face, p);
  foot.begins = !mesh && held_.face != face && foot.on_edge;
  return Followed::kOn;
}

/// Finds the nearest point of a face of the held body. If the nearest point of all certainly lies in the interior of
/// this face, it is that one, and the face need not be searched alone. Returns false, and leaves `hit`, if none is
/// found.
bool Tracer::nearestOn(std::uint32_t face, const Vector3d& p, Hit& hit) noexcept {
  const bool certain = nearestOnce(p).status == contact::FootStatus::kNearest;
  if (certain && nearest_.place == held_.place && nearest_.face == face && !isEdge(nearest_.hit)) {
    hit = nearest_.hit;
    return true;
  }
  const Nearest found = search_.nearestOf(held_.place, face, p, held_.hit, budget_);
  if (found.found()) hit = found.hit;
  return found.found();
}

/// Moves the foot to the nearest point of the held face, or over its edges to a neighbour that is nearer to the probe.
Followed Tracer::followFace(double side, const Vector3d& p) noexcept {
  for (int i = 0; i < kMaxCrossings; ++i) {
    if (held_.hit.element.kind() == ElementKind::kFace) {
      const Hit hit = search_.refine(held_.place, held_.hit, p);
      if (std::isfinite(hit.d2)) {
        held_.hit = hit;
        return Followed::kOn;
      }
    }
    if (!nearestOn(held_.face, p, held_.hit)) return Followed::kLost;
    if (!isEdge(held_.hit)) return Followed::kOn;
    Held next;
    next.hit.d2 = held_.hit.d2 * kNearer;
    if (slideOn(side, p, next) == Followed::kReleased) return Followed::kReleased;
    if (next.place == kNone) return Followed::kOn;
    held_ = next;
  }
  return Followed::kOn;
}

/// Examines the faces beyond the edge or vertex on which the held foot lies. `next` becomes the foot on the nearest of
/// these faces, if that foot is nearer.
Followed Tracer::slideOn(double side, const Vector3d& p, Held& next) noexcept {
  const std::uint32_t index = held_.hit.element.index();
  const std::uint32_t edge = held_.hit.element.kind() == ElementKind::kPiece ? model().piece(index).edge : index;
  const Edge& record = model().part().edges[edge];
  const auto region = static_cast<EdgeRegion>(held_.hit.region);
  const bool pole = held_.hit.element.kind() == ElementKind::kPole;
  const std::uint32_t vertex = region == EdgeRegion::kLast ? record.last_vertex : record.first_vertex;
  if ((region == EdgeRegion::kInside && !pole) || vertex == kNone) return slideOver(edge, held_.hit.u, side, p, next);
  slideAround(vertex, p, next);
  if (next.place != kNone) return Followed::kOn;
  for (const std::uint32_t e : model().edgesAt(vertex)) {
    const Edge& other = model().part().edges[e];
    if (other.curve == kNone) continue;
    const double t = other.first_vertex == vertex ? other.t0 : other.t1;
    if (slideOver(e, t, side, p, next) == Followed::kReleased) return Followed::kReleased;
  }
  return Followed::kOn;
}

/// Examines the faces around a vertex that the held foot reaches over smooth edges. Together they are one face, whose
/// walls must not catch or release a foot that passes beside them.
void Tracer::slideAround(std::uint32_t vertex, const Vector3d& p, Held& next) noexcept {
  FaceSet faces(held_.face);
  for (std::size_t i = 0; i < faces.count(); ++i)
    for (const std::uint32_t edge : model().edgesAt(vertex))
      if (const std::uint32_t face = smoothlyBeyond(model().part(), edge, faces[i]); faces.add(face))
        tryFace(face, p, next);
}

/// Makes `next` the foot on a face of the held body, if it is nearer.
void Tracer::tryFace(std::uint32_t face, const Vector3d& p, Held& next) noexcept {
  Hit hit;
  if (nearestOn(face, p, hit) && hit.d2 < next.hit.d2) next = {held_.place, face, hit};
}

/// Moves the foot of a contact, which seems to have ended at an edge, to the nearest of the faces that the held face
/// reaches over smooth edges. A probe that passes a sharp re-entrant corner of a flat face of several faces may come
/// nearer to the wall beside the corner than to the edge between two of them. Returns false if it is behind no face.
bool Tracer::slideAside(double side, const Vector3d& p, Foot& foot) noexcept {
  if (held_.hit.element.kind() == ElementKind::kTriangle) return false;  // goStraight() has passed the corner
  const Part& part = model().part();
  constexpr int kMostEdges = 256, kMostFaces = 8;
  int edges = 0;
  FaceSet faces(held_.face, kMostFaces);
  Held next;
  for (std::size_t i = 0; i < faces.count() && edges < kMostEdges; ++i)
    edges += eachEdgeOf(part, faces[i], kMostEdges - edges, [&](std::uint32_t edge) {
      if (const std::uint32_t face = smoothlyBeyond(part, edge, faces[i]); faces.add(face)) tryFace(face, p, next);
    });
  if (next.place == kNone) return false;
  const Foot found = describe(model(), next.place, next.hit, next.face, p);
  if (found.on_edge || !(contact::seenFrom(found, side).depth > 0)) return false;
  held_ = next;
  foot = found;
  return true;
}

/// Examines the faces beyond an edge of the held face. `next` becomes the foot on the nearest of these faces, if that
/// foot is nearer.
Followed Tracer::slideOver(std::uint32_t edge, double t, double side, const Vector3d& p, Held& next) noexcept {
  const Part& part = model().part();
  const Geometry& geometry = model().geometry();
  const Coedge* own = nullptr;
  for (std::uint32_t c = part.edges[edge].first_coedge; c != kNone; c = part.coedges[c].next)
    if (part.coedges[c].face == held_.face) own = &part.coedges[c];
  if (own == nullptr) return Followed::kOn;  // an edge at the same vertex that does not bound the held face
  const Vector3d r = model().placements()[held_.place].toBody(p) - held_.hit.point;
  const Vector3d here = coedgeNormal(geometry, *own, t);
  const Vector3d out = outOf(geometry, *own, t, here);
  for (std::uint32_t c = part.edges[edge].first_coedge; c != kNone; c = part.coedges[c].next) {
    const Coedge& beyond = part.coedges[c];
    if (beyond.face == held_.face) continue;
    const Vector3d there = side * coedgeNormal(geometry, beyond, t);
    const contact::EdgeKind kind = contact::edgeKind(side * here, there, out);
    if (contact::atEdge(kind, there, r) == AtEdge::kRelease) return Followed::kReleased;
    tryFace(beyond.face, p, next);
  }
  return Followed::kOn;
}

/// Moves the foot straight to the probe over a flat face of many triangles. A descent from triangle to triangle would
/// end at a re-entrant corner of this face, if the probe passes it from one tick to the next. Returns false, and leaves
/// the foot, if the way meets an edge over which the surface bends, or ends in the held triangle.
bool Tracer::goStraight(const Vector3d& p) noexcept {
  const Part& part = model().part();
  std::uint32_t triangle = held_.face, entered = kNone;
  Vector3d from = held_.hit.point;
  for (int n = 0; n < kMaxTriangles; ++n) {
    const Exit exit = exitOf(part, triangle, entered, from, p);
    if (exit.edge == kNone || !isFlatOver(part, triangle, exit.edge)) return false;
    const std::uint32_t code = part.triangles[triangle].across[exit.edge];
    triangle = code / 4;
    entered = code % 4;
    from = exit.point;
    const Hit hit = footOn(part, triangle, p);
    if (static_cast<TriangleRegion>(hit.region) != TriangleRegion::kInside) continue;
    held_.hit = hit;
    held_.face = triangle;
    return true;
  }
  return false;
}

/// Moves the foot from triangle to triangle while the distance to the probe falls, until no triangle beside the foot is
/// nearer.
Followed Tracer::followTriangles(double side, const Vector3d& p_model) noexcept {
  const Vector3d p = model().placements()[held_.place].toBody(p_model);
  const Part& part = model().part();
  const Hit hit = footOn(part, held_.face, p);
  if (static_cast<TriangleRegion>(hit.region) == TriangleRegion::kInside) {
    held_.hit = hit;
    return Followed::kOn;
  }
  if (goStraight(p)) return Followed::kOn;
  held_.hit = hit;
  for (int n = 0; n < kMaxTriangles; ++n) {
    const auto region = static_cast<TriangleRegion>(held_.hit.region);
    if (region == TriangleRegion::kInside) return Followed::kOn;
    const bool corner = region >= TriangleRegion::kCorner0;
    const auto k = static_cast<std::uint32_t>(region) -
                   static_cast<std::uint32_t>(corner ? TriangleRegion::kCorner0 : TriangleRegion::kEdge0);
    Hit best = held_.hit;
    best.d2 *= kNearer;
    if (corner)
      lookAround(part, held_.face, k, p, best);
    else if (const std::uint32_t code = part.triangles[held_.face].across[k]; code != kNone)
      takeNearer(footOn(part, code / 4, p), best);
    if (best.element == held_.hit.element && isBesideNarrow(model(), held_.face)) passNarrow(part, held_.face, p, best);
    if (best.element == held_.hit.element)
      return !corner && isReleased(part, held_.face, held_.hit.point, k, side, p) ? Followed::kReleased : Followed::kOn;
    held_.hit = best;
    held_.face = best.element.index();
  }
  return Followed::kOn;
}

}  // namespace hapticd::brep
