// SPDX-License-Identifier: MIT
/// Follows the foot of a held contact over edges, and finds where the path of the probe meets a surface.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/contact/edge_rule.hpp"
#include "kernels/trace/faces.hpp"

namespace hapticd::trace {
namespace {

using contact::Followed;
using Eigen::Array2d;
using Eigen::Vector3d;

constexpr double kMet = 1e-8;       ///< [m] a point that is nearer to a surface than this counts as on it
constexpr int kMostCandidates = 8;  ///< most surfaces that are tested for a crossing
/// Share of the path: a crossing that lies before its start or beyond its end by less than this still counts.
constexpr double kBeyond = 1e-9;

/// A point where a straight path meets a patch.
struct PathHit {
  Array2d uv{0, 0};
  double share = 0;          ///< position on the path, 0 at its start and 1 at its end
  Vector3d normal{0, 0, 1};  ///< outward, unit
  bool found = false;
};

/// Solves S(u, v) = from + share * way by Newton's method, starting from a point near by. Each evaluation reduces
/// `budget` by 1.
PathHit intersect(const Patch& patch, const Vector3d& from, const Vector3d& way, PathHit at, int& budget) noexcept {
  constexpr int kMostSteps = 6;
  const double enough = std::max(kMet, kRounding * (from.lpNorm<1>() + way.lpNorm<1>()));
  spline::SurfacePoint E;
  for (int i = 0; i < kMostSteps && budget > 0; ++i) {
    patch.surface.evaluate1(at.uv[0], at.uv[1], E);
    --budget;
    const Vector3d miss = from + at.share * way - E.S, n = E.Su.cross(E.Sv);
    const double length = n.norm(), det = -n.dot(way);
    if (miss.norm() <= enough && length > 0) {
      at.normal = n * (patch.sign / length);
      at.found = true;
      return at;
    }
    if (!(std::abs(det) > 1e-12 * length * way.norm())) return at;
    // Cramer's rule for (Su Sv -way) (du dv ds) = miss.
    const double du = -miss.dot(E.Sv.cross(way)) / det, dv = miss.dot(E.Su.cross(way)) / det;
    at.uv = (at.uv + Array2d(du, dv)).max(patch.lo).min(patch.hi);
    at.share = std::clamp(at.share + miss.dot(n) / det, -1.0, 2.0);
  }
  return at;
}

/// True if one of these sides is a pole.
bool isAtPole(const Patch& patch, SideMask sides) noexcept {
  for (int at = 0; at < kSides; ++at)
    if ((sides & bit(at)) && patch.side(at).kind == SideKind::kPole) return true;
  return false;
}

}  // namespace

void Tracer::forgetContact() noexcept {
  for (Contact& contact : contacts_) {
    contact.state.forget();
    if (contact.held >= 0) tracks_[contact.held].held = false;
    contact.held = -1;
  }
}

void Tracer::popThrough() noexcept {
  hold(-1, -1);
  contacts_[0].state.popThrough(last_p_);
}

void Tracer::hold(int part, int track) noexcept {
  int& held = contactOf(part).held;
  if (held >= 0) tracks_[held].held = false;
  held = track;
  if (track >= 0) tracks_[track].held = true;
}

/// In a corner, the foot first goes on over a smooth side: there, the probe may have passed the plane of a face that
/// begins only beyond the corner, and is in front of no face.
Followed Tracer::follow(int part, double side, const Vector3d& p, const TraceOptions& options, Foot& foot) noexcept {
  if (contactOf(part).held < 0) return Followed::kLost;
  const int before = tracks_[contactOf(part).held].patch;
  int track = refine(contactOf(part).held, p, options);
  unfinished_ = false;
  for (int i = 0; i < kMaxCrossings && tracks_[track].foot.sides != 0; ++i) {
    const SideMask sides = tracks_[track].foot.sides;
    int next = slideSmoothly(track, p, options);
    for (int at = 0; at < kSides && next < 0; ++at)
      if ((sides & bit(at)) && isReleased(track, at, side, p)) return Followed::kReleased;
    for (int at = 0; at < kSides && next < 0; ++at)
      if (sides & bit(at)) next = slideOver(track, at, p, options);
    if (next < 0) break;
    hold(part, next);
    track = next;
  }
  admitUnfinished(track);
  foot = describe(track, p, 0);
  foot.begins = tracks_[track].patch != before && foot.on_edge;
  return Followed::kOn;
}

/// Returns the outward normal of the neighbour across a joined side, at the point of the side that is nearest to uv.
Vector3d Tracer::normalBeyond(const Patch& patch, int side, const Array2d& uv) const noexcept {
  const Side& edge = patch.side(side);
  const Patch& next = model_.patch(edge.patch);
  const double fraction = patch.fractionOn(side, uv);
  return next.normalAt(next.onSide(edge.side, edge.flipped ? 1 - fraction : fraction));
}

/// True if the surface goes on without an edge beyond each of some sides of a patch, near uv.
bool Tracer::goesOn(const Patch& patch, SideMask sides, const Array2d& uv) const noexcept {
  constexpr double kSmooth = 1 - 1e-6;  // cosine of the angle between the normals
  for (int at = 0; at < kSides; ++at) {
    if (!(sides & bit(at))) continue;
    if (patch.side(at).kind != SideKind::kJoined) return false;
    if (!(patch.normalAt(uv).dot(normalBeyond(patch, at, uv)) > kSmooth)) return false;
  }
  return true;
}

/// True if the held foot is on a convex edge that the probe has crossed, and the probe is in front of the next face.
bool Tracer::isReleased(int track, int side, double felt, const Vector3d& p) const noexcept {
  const Track& t = tracks_[track];
  const Patch& patch = model_.patch(t.patch);
  const Side& edge = patch.side(side);
  if (edge.kind != SideKind::kJoined) return false;
  spline::SurfacePoint E;
  patch.surface.evaluate1(t.foot.uv[0], t.foot.uv[1], E);
  const bool across_u = Patch::axisOf(side) == 0;
  const Vector3d along = across_u ? E.Sv : E.Su, across = (side % 2 == 0 ? -1.0 : 1.0) * (across_u ? E.Su : E.Sv);
  const double length2 = along.squaredNorm();
  if (!(length2 > 0)) return false;
  const Vector3d out = (across - along * (along.dot(across) / length2)).stableNormalized(), r = p - t.foot.S;
  if (!(r.dot(out) > 0)) return false;
  const Vector3d there = felt * normalBeyond(patch, side, t.foot.uv);
  const contact::EdgeKind kind = contact::edgeKind(felt * surfaceNormal(track), there, out);
  return contact::atEdge(kind, there, r) == contact::AtEdge::kRelease;
}

/// Moves a held foot on beyond a side. Returns its new track, or -1 if the foot stays. Unlike crossSide(), the search
/// begins at the common side, even if another foot of the next patch is nearer.
int Tracer::slideOver(int track, int side, const Vector3d& p, const TraceOptions& options) noexcept {
  const int patch = tracks_[track].patch;
  const Patch& piece = model_.patch(patch);
  const Side& edge = piece.side(side);
  if (edge.kind == SideKind::kFree || isSpent()) return -1;
  if (edge.kind == SideKind::kPole) return leavePole(track, side, p, options, true);
  const double fraction = piece.fractionOn(side, tracks_[track].foot.uv);
  Iterate at;
  at.uv = model_.patch(edge.patch).onSide(edge.side, edge.flipped ? 1 - fraction : fraction);
  const LocalFoot foot = footFrom(edge.patch, at, p, options);
  unfinished_ = unfinished_ || !foot.converged;
  if (!(foot.distance < tracks_[track].foot.distance)) return -1;
  if (edge.patch != patch) return tracks_.put(edge.patch, at, foot);
  tracks_[track].at = at;
  tracks_[track].foot = foot;
  tracks_.refined(track);
  return track;
}

/// Moves a foot over a side beyond which the surface goes on without an edge. Returns its track, or -1 if it stays.
int Tracer::slideSmoothly(int track, const Vector3d& p, const TraceOptions& options) noexcept {
  const LocalFoot foot = tracks_[track].foot;
  const Patch& patch = model_.patch(tracks_[track].patch);
  int next = -1;
  for (int at = 0; at < kSides && next < 0; ++at)
    if ((foot.sides & bit(at)) && goesOn(patch, bit(at), foot.uv)) next = slideOver(track, at, p, options);
  return next;
}

/// Moves a foot of this tick on over sides beyond which the surface goes on without an edge. Returns its track.
int Tracer::slideOn(int track, const Vector3d& p, const TraceOptions& options) noexcept {
  for (int i = 0; i < kMaxCrossings && tracks_[track].foot.sides != 0; ++i) {
    const int next = slideSmoothly(track, p, options);
    if (next < 0) break;
    track = next;
  }
  return track;
}

/// Finds the first surface that a straight path to p enters through a side that is felt.
Tracer::Crossing Tracer::firstCrossing(int part, const Path& path, const Vector3d& p,
                                       const TraceOptions& options) noexcept {
  // A face that the path crosses is nearer to its end than this. So the layers of a rolled sheet are distinguished.
  const bool shell = options.rule.sides == contact::Sides::kBoth;
  const double within = (p - path.from.point).norm() - (shell ? path.from.clearance : 0);
  std::array<int, kMostCandidates> near{};
  int count = 0;
  for (const int index : tracks_.active()) {
    const bool reached = tracks_.atLeast(index) <= within && model_.patch(tracks_[index].patch).atLeast(p) <= within;
    if (!reached || (part >= 0 && tracks_[index].part != part)) continue;
    int at = std::min(count, kMostCandidates - 1);
    if (count == kMostCandidates && !(tracks_.atLeast(index) < tracks_.atLeast(near.back()))) continue;
    for (; at > 0 && tracks_.atLeast(index) < tracks_.atLeast(near[static_cast<std::size_t>(at) - 1]); --at)
      near[static_cast<std::size_t>(at)] = near[static_cast<std::size_t>(at) - 1];
    near[static_cast<std::size_t>(at)] = index;
    count = std::min(count + 1, kMostCandidates);
  }
  Crossing first;
  for (int i = 0; i < count; ++i) {
    int track = near[static_cast<std::size_t>(i)];
    if (tracks_[track].slot < 0) continue;
    if (budget_ > 0) track = slideOn(refine(track, p, options), p, options);
    const bool merged = first.track >= 0 && tracks_[first.track].tick != tracks_.tick();
    if (merged) first.track = track;
    const LocalFoot& foot = tracks_[track].foot;
    if (tracks_[track].tick != tracks_.tick() || !(foot.distance <= within + kMet)) continue;
    Crossing crossing;
    crossing.side = path.touching;
    crossing.track = track;
    const bool of_closed = path.closed >= 0 && shellOf(track) == path.closed, undecided = undecided_;
    crossing.sure = of_closed && model_.closed(path.closed);
    const bool entered = crosses(track, path.from.point, p, options, crossing);
    if (of_closed) undecided_ = undecided;  // the side of the nearest foot decides there
    if (!entered || !(crossing.share < first.share)) continue;
    // A path that seems to begin on the other side of a shell without an end near by has come through it before, at an
    // edge or corner.
    if (of_closed && crossing.side != path.touching) continue;
    if (shell || (options.rule.sides == contact::Sides::kFront) == (crossing.side > 0)) first = crossing;
  }
  return first;
}

/// Returns the height of a point over the surface, near a foot of this tick. The height over the tangent plane at that
/// foot has another sign if a path grazes the surface: its start is over a sphere, and under the plane. So has the
/// height over the end of a patch, if the surface goes on beyond it.
Tracer::HeightOver Tracer::heightOver(int track, const Vector3d& point) noexcept {
  constexpr double kNear = 1e-6;  // [m] the height changes by the square of an error of the foot
  int patch = tracks_[track].patch;
  Array2d uv = tracks_[track].foot.uv;
  LocalFoot below;
  below.distance = kInfinity;
  for (int i = 0; i < kMaxCrossings && budget_ > 0; ++i) {
    Iterate at;
    at.uv = uv;
    const LocalFoot foot = newtonFoot(model_.patch(patch), point, at, kNear, budget_);
    budget_ -= foot.evaluations;
    if (!foot.converged || isAtPole(model_.patch(patch), foot.sides)) return {};
    const bool nearer = foot.distance < below.distance;
    if (nearer) below = foot;
    const int side = nearer ? sideBeyond(model_.patch(patch), foot) : -1;
    if (side < 0) return below.regular ? HeightOver{below.height, below.sides == 0} : HeightOver();
    const Side& edge = model_.patch(patch).side(side);
    const double fraction = model_.patch(patch).fractionOn(side, foot.uv);
    patch = edge.patch;
    uv = model_.patch(patch).onSide(edge.side, edge.flipped ? 1 - fraction : fraction);
  }
  return {};
}

/// True if a point is certainly on the side of the surface on which the probe is, near a foot of this tick.
bool Tracer::isOnSameSide(int track, const Vector3d& point) noexcept {
  const LocalFoot& foot = tracks_[track].foot;
  if (!foot.regular || foot.sides != 0) return false;
  const HeightOver over = heightOver(track, point);
  return over.inside && std::abs(over.height) > kMet && over.height * foot.height > 0;
}

/// True if the nearest foot lies on another patch than the held one, and the two patches have a corner in common.
bool Tracer::isNextToHeld(int part) const noexcept {
  const int held = tracks_[contacts_[static_cast<std::size_t>(std::max(part, 0))].held].patch;
  const int next = tracks_[nearestTrack(part)].patch;
  const auto& corners = model_.patch(held).corners;
  const auto& others = model_.patch(next).corners;
  return next != held &&
         std::find_first_of(corners.begin(), corners.end(), others.begin(), others.end()) != corners.end();
}

/// Returns the side on which a foot lies and beyond which the surface goes on without an edge, or -1.
int Tracer::sideBeyond(const Patch& patch, const LocalFoot& foot) const noexcept {
  for (int at = 0; at < kSides; ++at)
    if ((foot.sides & bit(at)) && goesOn(patch, bit(at), foot.uv)) return at;
  return -1;
}

/// Tests whether the path from `from` to p crosses the surface near a foot of this tick, and where.
bool Tracer::crosses(int track, const Vector3d& from, const Vector3d& p, const TraceOptions& options,
                     Crossing& crossing) noexcept {
  const LocalFoot foot = tracks_[track].foot;
  const Patch& patch = model_.patch(tracks_[track].patch);
  const Vector3d way = p - from;
  // The tangent plane is enough for a solid: the probe is then inside, and its nearest face is as good as that of
  // entry.
  const Vector3d n = surfaceNormal(track);
  const bool shell = options.rule.sides == contact::Sides::kBoth;
  const double before = shell ? heightOver(track, from).height : (from - foot.S).dot(n), after = (p - foot.S).dot(n);
  if (std::abs(before) > kMet) crossing.side = before > 0 ? 1 : -1;
  if (!(crossing.side * after < 0)) return false;
  PathHit start;
  start.uv = foot.uv;
  start.share = std::clamp(before / (before - after), 0.0, 1.0);
  const PathHit met = intersect(patch, from, way, start, budget_);
  crossing.share = met.share;
  if (met.found && met.share >= -kBeyond && met.share <= 1 + kBeyond && crossing.side * way.dot(met.normal) < 0)
    return true;
  if (shell && !met.found && budget_ <= 0 && !crossing.sure) {
    undecided_ = true;
    return false;
  }
  // If the path grazes the surface, it may meet it a second time, and that place was found. There is another one
  // between its ends, unless the path passes beside the surface.
  crossing.share = start.share;
  const SideMask sides = patch.sidesAt(met.uv);
  return foot.sides == 0 && (isAtPole(patch, sides) || goesOn(patch, sides, met.uv));
}

}  // namespace hapticd::trace
