// SPDX-License-Identifier: MIT
/// Decides on which side of a part the probe is, from the nearest point and the normals around it: on a face, an edge
/// or a corner.
#include <Eigen/Geometry>
#include <cmath>

#include "kernels/brep/contact/tracer.hpp"
#include "kernels/brep/elements/feet.hpp"
#include "kernels/brep/geometry/triangle_foot.hpp"
#include "kernels/brep/model/narrow_triangles.hpp"
#include "kernels/brep/model/topology.hpp"
#include "kernels/contact/edge_rule.hpp"

namespace hapticd::brep {
namespace {

using contact::Foot;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// [m] If the probe is nearer to an edge than this, the direction from the foot to the probe is mostly rounding error;
/// the force is nearly zero there.
constexpr double kTouching = 1e-7;

/// The outward normal at a nearest point, and what kind of point it is.
struct Around {
  Vector3d normal{0, 0, 1};  ///< outward normal; on edges and corners the pseudonormal (Baerentzen & Aanaes 2005)
  Vector3d felt{0, 0, 0};    ///< interpolated normal of a smoothed mesh, or 0
  double u = 0, v = 0;       ///< parameters on the face
  bool inside = true;        ///< true in the interior of a face, where the normal is exact
  bool open = false;         ///< true if the surface ends there
  bool sharp = false;        ///< true if the normal jumps there
};

/// Returns the coedge of an edge on a face, or the edge's first coedge if the edge is not on the face.
const Coedge& coedgeOn(const Part& part, const Edge& edge, std::uint32_t face) noexcept {
  for (std::uint32_t c = edge.first_coedge; c != kNone; c = part.coedges[c].next)
    if (part.coedges[c].face == face) return part.coedges[c];
  return part.coedges[edge.first_coedge];
}

Around onFace(const Model& model, const Hit& hit) noexcept {
  Around a;
  a.u = hit.u;
  a.v = hit.v;
  const std::uint32_t i = hit.element.index();
  if (hit.element.kind() == ElementKind::kFace) {
    a.normal = faceNormal(model.face(i), hit.point);
    return a;
  }
  const Face& face = model.part().faces[model.leaf(i).face];
  a.normal = model.geometry().normal(face, Vector2d(hit.u, hit.v));
  if ((face.flags & kReversed) != 0) a.normal = -a.normal;
  return a;
}

/// Returns the outward normal of a face at a point of one of its edges: parameter t, place q.
Vector3d normalBeside(const Model& model, const Coedge& coedge, double t, const Vector3d& q) noexcept {
  const FaceShape& face = model.face(coedge.face);
  return face.kind <= SurfaceKind::kTorus ? faceNormal(face, q) : coedgeNormal(model.geometry(), coedge, t);
}

Around onEdge(const Model& model, const Hit& hit, std::uint32_t face) noexcept {
  const Part& part = model.part();
  const Edge& edge = part.edges[model.edgeOf(hit.element)];
  Around a;
  a.inside = false;
  if (edge.first_coedge == kNone) return a;
  const Coedge& own = coedgeOn(part, edge, face);
  const double t = edge.curve == kNone ? 0.5 * (own.t0 + own.t1) : hit.u;
  const Vector2d uv = model.geometry().planeCurve(own.pcurve, t).c;
  a.u = uv[0];
  a.v = uv[1];
  a.open = edge.kind == EdgeKind::kFree;
  a.sharp = edge.kind != EdgeKind::kSmooth && edge.kind != EdgeKind::kPole;
  const auto region = static_cast<EdgeRegion>(hit.region);
  const bool corner = region != EdgeRegion::kInside || edge.curve == kNone;
  const std::uint32_t vertex = region == EdgeRegion::kLast ? edge.last_vertex : edge.first_vertex;
  if (corner && vertex != kNone) {
    const CornerNormal& known = model.vertexNormal(vertex);
    a.open = a.open || known.open;
    if (!a.open && known.normal.squaredNorm() > 0) {
      a.normal = known.normal.cast<double>();
      return a;
    }
  }
  Vector3d sum = Vector3d::Zero();
  for (std::uint32_t c = edge.first_coedge; c != kNone && !a.open; c = part.coedges[c].next)
    sum += normalBeside(model, part.coedges[c], t, hit.point);
  a.normal = sum.squaredNorm() > 0 ? sum.normalized() : normalBeside(model, own, t, hit.point);
  return a;
}

/// Returns the normal interpolated over a smoothed triangle, or 0 if the triangle is not smoothed.
Vector3d smoothed(const Model& model, std::uint32_t triangle, double s, double t) noexcept {
  const Eigen::Vector3f* corner[3];
  for (int k = 0; k < 3; ++k) corner[k] = model.smoothNormal(triangle, k);
  if (corner[0] == nullptr || corner[1] == nullptr || corner[2] == nullptr) return Vector3d::Zero();
  const Vector3d n =
      (1 - s - t) * corner[0]->cast<double>() + s * corner[1]->cast<double>() + t * corner[2]->cast<double>();
  return n.squaredNorm() > 0 ? Vector3d(n.normalized()) : n;
}

/// True if the surface is smooth over edge k: the normals of the two triangles are interpolated over the edge, or
/// agree.
bool isSmooth(const Model& model, std::uint32_t triangle, std::uint32_t k) noexcept {
  const Part& part = model.part();
  const std::uint32_t code = part.triangles[triangle].across[k];
  if (code == kNone) return false;
  const std::uint32_t other = code / 4, m = code % 4;
  const Eigen::Vector3f *here = model.smoothNormal(triangle, static_cast<int>(k)),
                        *there = model.smoothNormal(other, static_cast<int>((m + 1) % 3));
  if (here != nullptr && here == there) return true;
  const Vector3d n = triangleNormal(part, part.triangles[triangle]);
  const Vector3d next = triangleNormal(part, part.triangles[other]);
  return n.dot(next) > 0 && n.cross(next).squaredNorm() < contact::kSmoothEdge * contact::kSmoothEdge;
}

Around onTriangle(const Model& model, const Hit& hit) noexcept {
  const Part& part = model.part();
  const std::uint32_t i = hit.element.index();
  const Triangle& t = part.triangles[i];
  Around a;
  a.u = hit.u;
  a.v = hit.v;
  a.normal = triangleNormal(part, t);
  a.felt = smoothed(model, i, hit.u, hit.v);
  const auto region = static_cast<TriangleRegion>(hit.region);
  if (region == TriangleRegion::kInside) return a;
  a.inside = false;
  if (region >= TriangleRegion::kCorner0) {
    const std::uint32_t k = static_cast<std::uint32_t>(region) - static_cast<std::uint32_t>(TriangleRegion::kCorner0);
    const CornerNormal& known = model.pointNormal(t.corner[k]);
    a.open = known.open;
    a.sharp = !(isSmooth(model, i, k) && isSmooth(model, i, (k + 2) % 3));
    if (!a.open && known.normal.squaredNorm() > 0) a.normal = known.normal.cast<double>();
  } else {
    const std::uint32_t k = static_cast<std::uint32_t>(region) - static_cast<std::uint32_t>(TriangleRegion::kEdge0);
    a.open = t.across[k] == kNone;
    a.sharp = !isSmooth(model, i, k);
    constexpr int kMostAround = 64;
    Vector3d sum = a.normal;
    std::uint32_t code = t.across[k];
    for (int n = 0; code != kNone && code / 4 != i && n < kMostAround; ++n) {
      sum += triangleNormal(part, part.triangles[code / 4]);
      code = part.triangles[code / 4].across[code % 4];
    }
    if (!a.open && sum.squaredNorm() > 0) a.normal = sum.normalized();
  }
  if (a.sharp) a.felt.setZero();
  return a;
}

/// Replaces the normal of a foot on a narrow triangle, or on an edge or a corner of one.
void leaveOutNarrow(const Model& model, const Hit& hit, const Vector3d& r, Around& a) noexcept {
  if (a.open || !model.hasNarrow()) return;
  const std::uint32_t triangle = hit.element.index();
  const double distance = std::sqrt(hit.d2);
  if (a.inside && !isNarrow(model.part(), triangle, distance)) return;  // its corners are in the cache
  if (!isBesideNarrow(model, triangle)) return;
  const NearFoot near(model.part(), triangle, hit.point, distance);
  if (!near.hasNarrow()) return;
  const Vector3d normal = near.normalToward(model.part(), r);
  if (!normal.isZero(0)) a.normal = normal;
}

/// Sets the depth and the normal of a foot, in the frame of its body.
void decideSide(const Around& a, const Vector3d& r, Foot& foot) noexcept {
  foot.normal = a.normal;
  foot.on_edge = a.sharp || a.open;
  const double behind = -r.dot(a.normal);
  if (a.open && !a.inside) {
    // The solid behind an open surface ends in a bevel of 45 degrees, so that the force fades out when the probe slides
    // off.
    foot.behind = behind;
    foot.aside = (r + behind * a.normal).norm();
    foot.depth = behind > foot.aside ? behind - foot.aside : -foot.distance;
    return;
  }
  foot.depth = foot.behind = behind > 0 ? foot.distance : -foot.distance;
  if (!a.inside && foot.distance > kTouching) foot.normal = r * (-1 / foot.depth);
  if (!a.felt.isZero(0)) foot.normal = a.felt;
}

}  // namespace

std::uint32_t faceOf(const Model& model, const Hit& hit, std::uint32_t before) noexcept {
  const std::uint32_t i = hit.element.index();
  switch (hit.element.kind()) {
    case ElementKind::kFace:
    case ElementKind::kTriangle:
      return i;
    case ElementKind::kLeaf:
      return model.leaf(i).face;
    default: {
      const Edge& edge = model.part().edges[model.edgeOf(hit.element)];
      return edge.first_coedge == kNone ? kNone : coedgeOn(model.part(), edge, before).face;
    }
  }
}

Foot describe(const Model& model, std::uint32_t place, const Hit& hit, std::uint32_t face, const Vector3d& p) noexcept {
  const Placement& placement = model.placements()[place];
  const Body& body = model.part().bodies[placement.body];
  const Vector3d r = placement.toBody(p) - hit.point;
  Around a;
  switch (hit.element.kind()) {
    case ElementKind::kFace:
    case ElementKind::kLeaf:
      a = onFace(model, hit);
      break;
    case ElementKind::kTriangle:
      a = onTriangle(model, hit);
      leaveOutNarrow(model, hit, r, a);
      break;
    default:
      a = onEdge(model, hit, face);
      break;
  }
  Foot foot;
  foot.distance = std::sqrt(hit.d2);
  foot.point = hit.point;
  foot.u = a.u;
  foot.v = a.v;
  decideSide(a, r, foot);
  const std::uint32_t first = body.kind == BodyKind::kMesh ? body.first_triangle : body.first_face;
  foot.surface = face == kNone ? 0 : static_cast<int>(placement.first_feature + face - first);
  foot.status = contact::FootStatus::kNearest;
  if (placement.moved) {
    foot.point = placement.rotation * foot.point + placement.position;
    foot.normal = placement.rotation * foot.normal;
  }
  return foot;
}

Vector3d surfaceNormal(const Model& model, std::uint32_t place, const Hit& hit, const Foot& foot) noexcept {
  if (hit.element.kind() != ElementKind::kTriangle) return foot.normal;
  const Around a = onTriangle(model, hit);
  return a.felt.isZero(0) ? foot.normal : Vector3d(model.placements()[place].rotation * a.normal);
}

}  // namespace hapticd::brep
