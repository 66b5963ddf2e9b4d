// SPDX-License-Identifier: MIT
/// Follows the foot point of a track over the sides of patches, their seams and poles, as long as it comes nearer.
#include <algorithm>
#include <cmath>

#include "kernels/trace/faces.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

/// [m] a neighbour that the host did not activate is dropped beyond this distance.
constexpr double kNeighbourReach = 0.15;

}  // namespace

/// Replaces a foot by the foot found from (u, v) on the same patch, if the new foot is nearer. Returns true if it was
/// replaced.
bool Tracer::tryFrom(int track, const Array2d& uv, const Vector3d& p, const TraceOptions& options) noexcept {
  if (isSpent()) return false;
  Track& t = tracks_[track];
  Iterate other;
  other.uv = uv;
  const LocalFoot foot = footFrom(t.patch, other, p, options);
  unfinished_ = unfinished_ || !foot.converged;
  if (!(foot.distance < t.foot.distance)) return false;
  t.foot = foot;
  t.at = other;
  tracks_.refined(track);
  return true;
}

/// True if no evaluations are left in this tick, so that a place beyond a side remains unseen.
bool Tracer::isSpent() noexcept {
  unfinished_ = unfinished_ || budget_ <= 0;
  return budget_ <= 0;
}

/// Follows a foot across the sides that it meets, as long as it comes nearer. Returns its last track. If the
/// evaluations end before that, the foot is not certain.
int Tracer::cross(int track, const Vector3d& p, const TraceOptions& options) noexcept {
  unfinished_ = false;
  for (int i = 0; i < kMaxCrossings && tracks_[track].foot.sides != 0 && !isSpent(); ++i) {
    const SideMask sides = tracks_[track].foot.sides;
    int next = -1;
    for (int side = 0; side < kSides && next < 0; ++side)
      if (sides & bit(side)) next = crossSide(track, side, p, options);
    if (next < 0) break;
    track = next;
  }
  admitUnfinished(track);
  return track;
}

/// Marks a foot as not certain if a place beyond one of its sides remains unseen.
void Tracer::admitUnfinished(int track) noexcept {
  LocalFoot& foot = tracks_[track].foot;
  if (unfinished_ && model_.patch(tracks_[track].patch).continuesBeyond(foot.sides)) foot.converged = false;
}

/// Follows a foot across the seams and poles that it meets. Beyond other sides another track follows the foot. Beyond a
/// seam or pole there is none, so a foot that stayed there would make the surface seem farther than it is.
void Tracer::crossSeams(int track, const Vector3d& p, const TraceOptions& options) noexcept {
  const Track& t = tracks_[track];
  for (int side = 0; side < kSides; ++side) {
    const Side& edge = model_.patch(t.patch).side(side);
    if (!(t.foot.sides & bit(side))) continue;
    const bool seam = edge.kind == SideKind::kJoined && edge.patch == t.patch;
    if (edge.kind == SideKind::kPole && leavePole(track, side, p, options, false) >= 0) return;
    if (seam && crossSide(track, side, p, options) >= 0) return;
  }
}

/// True if a patch should start from (u, v), where a neighbour's foot `there` has reached the common side, instead of
/// from its own foot. This is so if its own foot is farther from the probe, far from `there`, and was not refined in
/// this tick.
bool Tracer::isFarther(int patch, const Array2d& uv, const LocalFoot& there, const Vector3d& p) const noexcept {
  constexpr double kAway = 0.05;  // difference of parameters, relative to their range
  const Track& t = tracks_[patch];
  if (t.tick == tracks_.tick() || t.held) return false;
  if (t.at.known == Iterate::Known::kParameters)
    return ((t.at.uv - uv).abs() > kAway * (model_.patch(patch).hi - model_.patch(patch).lo)).any();
  return (t.at.E.S - p).norm() > there.distance && (t.at.E.S - there.S).norm() > there.distance;
}

/// Follows a foot across a side. Returns the track on which the foot is nearer to the probe, or -1 if there is none.
int Tracer::crossSide(int track, int side, const Vector3d& p, const TraceOptions& options) noexcept {
  const double tolerance = options.tolerance;
  const int patch = tracks_[track].patch;
  const Patch& piece = model_.patch(patch);
  const Side& edge = piece.side(side);
  if (edge.kind == SideKind::kFree) return -1;
  if (edge.kind == SideKind::kPole) return leavePole(track, side, p, options, true);
  const double best = tracks_[track].foot.distance;
  const double fraction = piece.fractionOn(side, tracks_[track].foot.uv);
  const Array2d there = model_.patch(edge.patch).onSide(edge.side, edge.flipped ? 1 - fraction : fraction);
  if (edge.patch == patch) return tryFrom(track, there, p, options) ? track : -1;
  const int next = edge.patch;
  tracks_.follow(next, there);
  if (isFarther(next, there, tracks_[track].foot, p)) tracks_.restart(next, there);
  if (!isSpent()) refine(next, p, options);
  if (tracks_[next].tick != tracks_.tick()) return -1;
  unfinished_ = unfinished_ || !tracks_[next].foot.converged;
  // The common side belongs to the neighbour too. If the neighbour's foot is farther than the point there, it is at
  // another local minimum.
  if (tracks_[next].foot.distance > best + tolerance) {
    if (tracks_[next].held) return slideOver(track, side, p, options);
    const Iterate at = tracks_[next].at;
    const LocalFoot foot = tracks_[next].foot;
    if (tryFrom(next, there, p, options) && foot.distance < best + Model::kSoon) tracks_.keepAsRival(next, at, foot);
  }
  const bool nearer = tracks_[next].foot.distance < best;
  if (!nearer && !tracks_[next].asked && tracks_[next].foot.distance > kNeighbourReach) dropUnlessHeld(next);
  return nearer ? next : -1;
}

/// Moves a foot away from a pole, along the ray that leads nearest to the probe. The ray is in the same patch or, if
/// `around` is true, in any patch that ends at this point. Returns the track on which the foot is nearer to the probe,
/// or -1 if there is none.
int Tracer::leavePole(int track, int side, const Vector3d& p, const TraceOptions& options, bool around) noexcept {
  constexpr double kOutward = 1e-9;  // cosine; rays at right angles to the direction of the probe do not come nearer
  constexpr int kMostFans = 16;
  const int patch = tracks_[track].patch;
  const double best_distance = tracks_[track].foot.distance;
  const Vector3d r = p - tracks_[track].foot.S;
  const int own = model_.patch(patch).side(side).pole;
  int best_fan = own, best = 0;
  double most = -kInfinity;
  for (int fan = own, n = 0; n < kMostFans; ++n) {
    for (int i = 0; i < PoleFan::kRays; ++i) {
      const double gain = r.dot(model_.pole(fan).direction[static_cast<std::size_t>(i)]);
      if (!(gain > most)) continue;
      most = gain;
      best = i;
      best_fan = fan;
    }
    fan = model_.pole(fan).next;
    if (!around || fan == own) break;
  }
  if (!(most > kOutward * r.norm())) return -1;
  const PoleFan& fan = model_.pole(best_fan);
  const auto ray = static_cast<std::size_t>(best);
  const Patch& piece = model_.patch(fan.patch);
  const int axis = Patch::axisOf(fan.side);
  const double range = piece.hi[axis] - piece.lo[axis];
  const double inward = std::clamp(most / std::max(fan.speed[ray], 1e-300), 1e-6 * range, 0.25 * range);
  Array2d uv;
  uv[axis] = fan.side % 2 == 0 ? piece.lo[axis] + inward : piece.hi[axis] - inward;
  uv[1 - axis] = fan.along[ray];
  if (fan.patch == patch) return tryFrom(track, uv, p, options) ? track : -1;
  const int next = fan.patch;
  tracks_.follow(next, uv);
  if (!isSpent()) refine(next, p, options);
  if (tracks_[next].tick != tracks_.tick()) return -1;
  unfinished_ = unfinished_ || !tracks_[next].foot.converged;
  if (!(tracks_[next].foot.distance < best_distance)) tryFrom(next, uv, p, options);
  return tracks_[next].foot.distance < best_distance ? next : -1;
}

}  // namespace hapticd::trace
