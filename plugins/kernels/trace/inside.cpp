// SPDX-License-Identifier: MIT
/// Decides on which side of the model the probe is, from the place of the nearest foot: on a face, an edge or a corner.
#include <Eigen/Geometry>

#include "kernels/trace/tracer.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

/// [m] If the probe is nearer to an edge than this, the direction from the foot to the probe is mostly rounding error;
/// the force is nearly zero there.
constexpr double kTouching = 1e-7;

}  // namespace

Vector3d Tracer::surfaceNormal(int track) const noexcept {
  const LocalFoot& foot = tracks_[track].foot;
  return foot.regular ? foot.normal : model_.patch(tracks_[track].patch).normalAt(foot.uv);
}

/// Returns the pseudonormal of the edge or corner on which the foot lies. A probe in its direction is outside
/// (Baerentzen & Aanaes 2005).
Vector3d Tracer::edgeNormal(int track) const noexcept {
  const Patch& piece = model_.patch(tracks_[track].patch);
  const LocalFoot& foot = tracks_[track].foot;
  int only = -1;
  bool corner = false;
  for (int side = 0; side < kSides; ++side) {
    if (!(foot.sides & bit(side))) continue;
    corner = corner || only >= 0 || piece.side(side).kind == SideKind::kPole;
    only = side;
  }
  if (corner) {
    const int at = (foot.uv[0] == piece.hi[0] ? 1 : 0) + (foot.uv[1] == piece.hi[1] ? 2 : 0);
    const Vector3d& n = model_.vertexNormal(piece.corners[static_cast<std::size_t>(at)]);
    if (n.squaredNorm() > 0) return n;
  }
  const Side& edge = piece.side(only);
  const Vector3d n = surfaceNormal(track);
  if (edge.kind != SideKind::kJoined) return n;
  const double fraction = piece.fractionOn(only, foot.uv);
  const Patch& next = model_.patch(edge.patch);
  const Vector3d sum = n + next.normalAt(next.onSide(edge.side, edge.flipped ? 1 - fraction : fraction));
  return sum.squaredNorm() > 0 ? Vector3d(sum.normalized()) : n;
}

Foot Tracer::describe(int track, const Vector3d& p, int evaluations) const noexcept {
  const Patch& piece = model_.patch(tracks_[track].patch);
  const LocalFoot& local = tracks_[track].foot;
  Foot foot;
  foot.point = local.S;
  foot.normal = local.normal;
  foot.depth = foot.behind = -local.height;
  foot.distance = local.distance;
  foot.u = local.uv[0];
  foot.v = local.uv[1];
  foot.residual = local.residual;
  foot.surface = piece.source;
  foot.evaluations = evaluations;
  foot.status = local.converged ? FootStatus::kNearest : FootStatus::kDegraded;
  foot.on_edge = local.sides != 0;
  if (local.sides != 0 || !local.regular || !model_.hasArea()) [[unlikely]]
    decideSide(track, p, foot);
  return foot;
}

/// Sets the normal and the depth of a foot on an edge or corner, where the tangents do not give them.
void Tracer::decideSide(int track, const Vector3d& p, Foot& foot) const noexcept {
  const Patch& piece = model_.patch(tracks_[track].patch);
  const LocalFoot& local = tracks_[track].foot;
  const Vector3d r = p - local.S;
  if (!model_.hasArea()) {  // its normal, if there is one, is arbitrary, and would pull a hand from anywhere
    foot.normal = foot.distance > kTouching ? Vector3d(r / foot.distance) : Vector3d(0, 0, 1);
    foot.depth = foot.behind = -foot.distance;
    return;
  }
  if (local.sides == 0) {
    foot.normal = surfaceNormal(track);
    foot.depth = foot.behind = -r.dot(foot.normal);
    return;
  }
  bool open = false;
  for (int side = 0; side < kSides; ++side)
    open = open || ((local.sides & bit(side)) && piece.side(side).kind == SideKind::kFree);
  foot.normal = open ? surfaceNormal(track) : edgeNormal(track);
  foot.behind = -r.dot(foot.normal);
  if (open) {
    // The solid behind an open surface ends in a bevel of 45 degrees, so that the force fades out when the probe slides
    // off.
    foot.aside = (r + foot.behind * foot.normal).norm();
    foot.depth = foot.behind > foot.aside ? foot.behind - foot.aside : -foot.distance;
    return;
  }
  foot.depth = foot.behind = foot.behind > 0 ? foot.distance : -foot.distance;
  if (foot.distance > kTouching) foot.normal = r * (-1 / foot.depth);
}

}  // namespace hapticd::trace
