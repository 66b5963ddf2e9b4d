// SPDX-License-Identifier: MIT
#include "edge_steps.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "kernels/brep/contact/tracer.hpp"
#include "kernels/brep/model/topology.hpp"

namespace hapticd::bench {
namespace {

using brep::Model;
using Eigen::Vector3d;

constexpr double kPress = 1e-4;  ///< [m] depth of the probe below the surface
constexpr double kAside = 2e-6;  ///< [m] distance from the edge at which a stroke begins and ends
/// ticks of 10 nm each; so short that a curved face turns the force far less than an edge does
constexpr int kTicks = 400;

/// A point of a smooth edge between two faces, with the dihedral angle at this point.
struct Crossing {
  Vector3d point, normal, across;
  double dihedral;
  double gap;   ///< [m] largest distance between the edge and the pcurves of the two faces at this point
  double bend;  ///< [1/m] curvature toward the probe of the more curved face

  /// Returns the step [rad] of the force's direction that is allowed at the depth h = kPress. It has two parts. The
  /// angle between the normals is enlarged because the probe is nearer to the centre of curvature than the surface is.
  /// If the gap makes one face end higher than the other, its edge remains the nearest point for about sqrt(2 gap h).
  double allowed() const {
    const double nearer = 1 - std::max(bend, 0.0) * kPress;
    return (nearer > 0 ? dihedral / nearer : 4) + std::sqrt(2 * gap / kPress) + gap / kPress;
  }
};

double angleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

spline::SurfacePoint pointOf(const Model& model, const brep::Coedge& coedge, double t) {
  const Eigen::Vector2d uv = model.geometry().planeCurve(coedge.pcurve, t).c;
  spline::SurfacePoint at;
  model.geometry().surface(model.part().faces[coedge.face].surface, uv[0], uv[1], at);
  return at;
}

/// Returns the largest curvature [1/m] of a face away from its outward normal.
double bendInward(const spline::SurfacePoint& at, const Vector3d& normal) {
  Eigen::Matrix2d first, second;
  const double f = at.Su.dot(at.Sv), m = -normal.dot(at.Suv);
  first << at.Su.squaredNorm(), f, f, at.Sv.squaredNorm();
  second << -normal.dot(at.Suu), m, m, -normal.dot(at.Svv);
  const Eigen::Matrix2d shape = first.inverse() * second;
  const double mean = 0.5 * shape.trace(), bend = mean + std::sqrt(std::max(mean * mean - shape.determinant(), 0.0));
  return std::isfinite(bend) ? bend : 0;
}

std::optional<Crossing> crossingAt(const Model& model, const brep::Placement& place, const brep::Edge& edge,
                                   double share) {
  const brep::Coedge& one = model.part().coedges[edge.first_coedge];
  const brep::Coedge& other = model.part().coedges[one.next];
  const double t = edge.t0 + share * (edge.t1 - edge.t0);
  const Vector3d first = brep::coedgeNormal(model.geometry(), one, t);
  const Vector3d second = brep::coedgeNormal(model.geometry(), other, t);
  spline::CurvePoint C;
  model.geometry().curve(edge.curve, t, C);
  const Vector3d normal = (first + second).normalized(), across = normal.cross(C.C1).normalized();
  if (!normal.allFinite() || !across.allFinite()) return std::nullopt;
  const spline::SurfacePoint on_one = pointOf(model, one, t), on_other = pointOf(model, other, t);
  const double gap = std::max({(on_one.S - on_other.S).norm(), (on_one.S - C.C).norm(), (on_other.S - C.C).norm()});
  const double bend = std::max(bendInward(on_one, normal), bendInward(on_other, normal));
  return Crossing{place.rotation * C.C + place.position,
                  place.rotation * normal,
                  place.rotation * across,
                  angleBetween(first, second),
                  gap,
                  bend};
}

/// Returns by how much [rad] the largest step of a stroke exceeds the steps before and after it, which come from the
/// curvature of the faces. Returns -1 if the foot left the two faces.
double stepOver(brep::Tracer& tracer, const Crossing& at) {
  const auto probe = [&](double height, double aside) {
    return Vector3d(at.point + height * at.normal + aside * at.across);
  };
  tracer.reset();
  tracer.step(probe(kPress, -kAside), {});
  Vector3d last(0, 0, 0);
  std::vector<double> steps;
  for (int i = 0; i <= kTicks; ++i) {
    const Vector3d p = probe(-kPress, kAside * (2.0 * i / kTicks - 1));
    const contact::Foot foot = tracer.step(p, {});
    if (!(foot.depth > 0) || (foot.point - at.point).norm() > kPress) return -1;
    const Vector3d way = (foot.point - p).normalized();
    if (i > 0) steps.push_back(angleBetween(way, last));
    last = way;
  }
  const auto largest = std::max_element(steps.begin(), steps.end());
  double beside = 0;
  if (largest != steps.begin()) beside = *(largest - 1);
  if (largest + 1 != steps.end()) beside = std::max(beside, *(largest + 1));
  return *largest - beside;
}

}  // namespace

void measureEdgeSteps(const Model& model) {
  constexpr double kMore = 1e-6;  // [rad]
  brep::Tracer tracer(model);
  long crossings = 0, left_out = 0, above_angle = 0, above = 0;
  double largest = 0, worst = 0;
  for (const brep::Placement& place : model.placements()) {
    const brep::Body& body = model.part().bodies[place.body];
    for (std::uint32_t e = body.first_edge; e < body.first_edge + body.edge_count; ++e) {
      const brep::Edge& edge = model.part().edges[e];
      if (edge.kind != brep::EdgeKind::kSmooth || edge.coedge_count != 2 || edge.curve == brep::kNone) continue;
      for (const double share : {0.21, 0.5, 0.83}) {
        const auto at = crossingAt(model, place, edge, share);
        const double step = at ? stepOver(tracer, *at) : -1;
        if (step < 0) {
          ++left_out;
          continue;
        }
        ++crossings;
        above_angle += step > at->dihedral + kMore;
        largest = std::max(largest, step);
        above += step > at->allowed() + kMore;
        worst = std::max(worst, step - at->allowed());
        if (getenv("SHOW") && step > at->allowed() + kMore)
          std::printf("edge %u share %g step %.3g dihedral %.3g gap %.3g m tol %.3g bend %.3g\n", e, share, step,
                      at->dihedral, at->gap, edge.tolerance, at->bend);
      }
    }
  }
  std::printf(
      "  smooth edges: %ld crossings %.1f mm deep (%ld left out); the direction steps by at most %.2g rad; by more "
      "than "
      "the dihedral angle + 1e-6 rad %ld times,\n    by more than that angle, the faces' bend and the gap between them "
      "explain %ld times, by at most %.2g rad\n",
      crossings, kPress * 1e3, left_out, largest, above_angle, above, worst);
}

}  // namespace hapticd::bench
