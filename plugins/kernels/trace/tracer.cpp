// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "kernels/trace/faces.hpp"

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr double kFarthest = 1e150;  ///< [m] squares of larger coordinates overflow

/// Returns a foot that has only a status. The attributes keep this function out of the code path of the usual tick.
[[gnu::cold, gnu::noinline]] Foot nothing(FootStatus status) noexcept {
  Foot foot;
  foot.status = status;
  return foot;
}

/// True if (u, v) is near a pole of the patch. There the first-order steps of direct parametric tracing hardly turn
/// about the pole, since one tangent vanishes: the foot would lag, and a shell could be felt from the wrong side.
bool isNearPole(const Patch& patch, const Array2d& uv) noexcept {
  constexpr double kNear = 0.1;  // share of the range of the parameter
  const Array2d range = patch.hi - patch.lo, low = (uv - patch.lo) / range, high = (patch.hi - uv) / range;
  for (int side = 0; side < kSides; ++side) {
    if (patch.side(side).kind != SideKind::kPole) continue;
    if ((side % 2 == 0 ? low : high)[Patch::axisOf(side)] < kNear) return true;
  }
  return false;
}

/// True if a step of direct parametric tracing led away: the probe is now farther aside of its foot than the step was
/// long. So it is farther from the surface than the radius of its curvature, where these steps leave the foot.
inline bool ledAway(const LocalFoot& foot) noexcept {
  constexpr double kSettled = 1e-6;  // [m] a shorter step is a rounding error, or leads nowhere
  const double aside2 = foot.distance * foot.distance - foot.height * foot.height;
  return foot.residual > kSettled && foot.sides == 0 && aside2 > foot.residual * foot.residual;
}

}  // namespace

Tracer::Tracer(const Model& model) : model_(model), tracks_(model) {}

void Tracer::activate(int surface, double u, double v, double distance) noexcept {
  if (surface < 0 || surface >= model_.surfaceCount() || !std::isfinite(u) || !std::isfinite(v)) return;
  for (int i = model_.firstPatch(surface); i < model_.lastPatch(surface); ++i) {
    const int nearest = parts_[static_cast<std::size_t>(tracks_[i].part)].nearest;
    const double best = nearest >= 0 ? tracks_[nearest].foot.distance : kInfinity;
    tracks_.offer(i, {u, v}, distance, {last_p_, has_last_, best}, true);
  }
}

void Tracer::deactivate(int surface) noexcept {
  if (surface < 0 || surface >= model_.surfaceCount()) return;
  for (int i = model_.firstPatch(surface); i < model_.lastPatch(surface); ++i) drop(i);
  const auto& active = tracks_.active();
  const bool asked = std::any_of(active.begin(), active.end(), [this](int i) { return tracks_[i].asked; });
  while (!asked && !active.empty()) drop(active.back());
}

void Tracer::drop(int track) noexcept {
  tracks_.drop(track);
  const auto gone = [this](int i) { return i >= 0 && tracks_[i].slot < 0; };
  if (gone(nearest_)) nearest_ = -1;
  for (Part& part : parts_)
    if (gone(part.nearest)) part.nearest = -1;
  for (Contact& contact : contacts_)
    if (gone(contact.held)) contact.held = -1;
  if (tracks_.active().empty())
    for (Contact& contact : contacts_) contact.state.forget();
}

void Tracer::dropUnlessHeld(int track) noexcept {
  if (!tracks_[track].held) drop(track);
}

void Tracer::reset() noexcept {
  tracks_.clear();
  parts_.fill({});
  contacts_.fill({});
  nearest_ = -1;
  has_last_ = false;
}

bool Tracer::active(int surface) const noexcept {
  if (surface < 0 || surface >= model_.surfaceCount()) return false;
  for (int i = model_.firstPatch(surface); i < model_.lastPatch(surface); ++i)
    if (tracks_[i].slot >= 0) return true;
  return false;
}

/// Computes the foot near `at` on a patch. @param steps of method kDirect
inline void Tracer::findFoot(const Patch& patch, Iterate& at, const Vector3d& p, const TraceOptions& options, int steps,
                             LocalFoot& foot) noexcept {
  if (options.method == Method::kDirect && !isNearPole(patch, at.uv)) {
    directFoot(patch, p, at, steps, budget_, foot);
    budget_ -= foot.evaluations;
    if (!ledAway(foot)) return;
    foot.converged = false;
    if (budget_ <= 0) return;
  }
  newtonFoot(patch, p, at, std::max(options.tolerance, 0.0), budget_, foot);
  budget_ -= foot.evaluations;
}

/// Computes the foot of a track for this tick. For a track that does not have the nearest foot, one step shows how near
/// it is.
inline void Tracer::locate(int track, const Vector3d& p, const TraceOptions& options) noexcept {
  Track& t = tracks_[track];
  findFoot(model_.patch(t.patch), t.at, p, options, track == nearest_ ? options.iterations : 1, t.foot);
}

/// Computes the foot near `at` on a patch.
LocalFoot Tracer::footFrom(int patch, Iterate& at, const Vector3d& p, const TraceOptions& options) noexcept {
  LocalFoot foot;
  findFoot(model_.patch(patch), at, p, options, options.iterations, foot);
  return foot;
}

/// Records a foot that was computed by locate(). Returns its track, which may change because equal feet of a patch are
/// merged.
inline int Tracer::note(int track) noexcept {
  tracks_.refined(track);
  if (tracks_[tracks_[track].patch].rival < 0) [[likely]]
    return track;
  const int kept = tracks_.merge(track);
  const auto goesWith = [&](int& of) {
    if (of >= 0 && tracks_[of].slot < 0) of = kept;
  };
  goesWith(nearest_);
  for (Contact& contact : contacts_) goesWith(contact.held);
  return kept;
}

int Tracer::refine(int track, const Vector3d& p, const TraceOptions& options) noexcept {
  if (tracks_[track].tick == tracks_.tick()) return track;
  locate(track, p, options);
  return note(track);
}

/// True if the state of the contact does not change, so that the nearest foot is the result of this tick.
inline bool Tracer::isUnchanged(const Vector3d& p, const Vector3d& last, const TraceOptions& options) noexcept {
  Contact& contact = contacts_[0];
  const LocalFoot& foot = tracks_[nearest_].foot;
  if (contact.held >= 0 && contact.held != nearest_) return false;
  if (options.rule.hysteresis > 0 && !(foot.regular && foot.converged)) return false;
  // The foot may lag behind, and the face is nearer then. A solid feels a probe that went into it, however it went.
  const double distance = options.rule.sides == contact::Sides::kBoth
                              ? std::min(foot.distance - foot.residual, std::abs(foot.height))
                              : foot.distance;
  if (contact.state.isUnchanged(foot.height, distance, p, options.rule)) [[likely]]
    return true;
  return options.rule.hysteresis > 0 && distance > 0 && tracks_.isAlone(nearest_, (p - last).norm()) &&
         contact.state.isPassing(foot.height, distance, last, p, options.rule);
}

Foot Tracer::step(const Vector3d& p, const TraceOptions& options) noexcept {
  if (!(p.lpNorm<1>() <= kFarthest)) {  // also true for NaN
    forgetContact();
    return nothing(FootStatus::kInvalid);
  }
  const bool shell = options.rule.sides == contact::Sides::kBoth;
  const int budget = std::max(options.max_evaluations, shell ? TraceOptions::kForShell : 1);
  budget_ = budget;
  if (nearest_ >= 0) [[likely]]
    // This takes longest and depends on nothing below. It comes first, so that the processor does the rest in parallel.
    locate(nearest_, p, options);
  const Vector3d last = has_last_ ? last_p_ : p;
  if (has_last_) tracks_.gone((p - last).norm());
  last_p_ = p;
  has_last_ = true;
  tracks_.nextTick();
  if (nearest_ >= 0) [[likely]] {
    nearest_ = note(nearest_);
    parts_[static_cast<std::size_t>(tracks_[nearest_].part)].nearest = nearest_;
    if (tracks_[nearest_].foot.sides == 0 && model_.partCount() == 1 && tracks_.isNearest(nearest_) &&
        isUnchanged(p, last, options)) [[likely]] {
      if (options.rule.sides == contact::Sides::kFront) [[likely]]
        return describe(nearest_, p, budget - budget_);
      return contact::seenFrom(describe(nearest_, p, budget - budget_), contacts_[0].state.side());
    }
  }
  return settle(p, last, options, budget);
}

/// Computes the foot of a tick that needs more than the usual work of step(). It is a separate function, so that the
/// compiler constructs the Foot directly in the caller's memory and copies nothing.
Foot Tracer::settle(const Vector3d& p, const Vector3d& last, const TraceOptions& options, int budget) noexcept {
  Foot foot;
  if (!model_.hasArea()) {  // nothing that a path could cross
    foot = nearestFoot(-1, p, options);
  } else if (options.unite && model_.partCount() > 1) {
    foot = nearestFoot(-1, p, options);
    if (contact::found(foot)) uniteParts(p, last, options, foot);
  } else if (!(options.rule.hysteresis > 0) && options.rule.sides == contact::Sides::kFront) {
    hold(-1, -1);
    foot = nearestFoot(-1, p, options);
  } else {
    last_shell_ = shellOf(nearest_);
    undecided_ = false;
    Faces faces(*this, -1, p, options);
    foot = contacts_[0].state.step(faces, last, p, options.rule);
    budget += faces.granted();
  }
  if (contact::found(foot)) foot.evaluations = budget - budget_;
  return foot;
}

/// Returns the nearest foot of a part (-1 for all parts), with its outward normal.
Foot Tracer::nearestFoot(int part, const Vector3d& p, const TraceOptions& options) noexcept {
  Foot foot;
  if (part >= 0) return nearestOfPart(part, p, options, foot) ? foot : nothing(FootStatus::kIdle);
  nearest_ = nearestOf(-1, nearest_, p, options);
  if (nearest_ < 0) return nothing(FootStatus::kIdle);
  parts_[static_cast<std::size_t>(tracks_[nearest_].part)].nearest = nearest_;
  return describe(nearest_, p, 0);
}

/// Returns the track with the nearest foot of a part (-1 for all parts), refined in this tick. Track `start` is
/// examined first, unless it is -1.
int Tracer::nearestOf(int part, int start, const Vector3d& p, const TraceOptions& options) noexcept {
  double best = kInfinity;
  int nearest = -1;
  for (int index : tracks_.active()) {  // tracks that were refined in this tick already
    const Track& t = tracks_[index];
    if ((part >= 0 && t.part != part) || t.tick != tracks_.tick() || !(t.foot.distance < best)) continue;
    best = t.foot.distance;
    nearest = index;
  }
  int crossed = -1;  // track to which the foot of `start` has moved
  for (int index = start >= 0 ? start : tracks_.mostPromising(best, part); index >= 0 && budget_ > 0;
       index = tracks_.mostPromising(best, part)) {
    const bool last = index == start;
    if (const double bound = last ? 0 : model_.patch(tracks_[index].patch).atLeast(p); bound >= best) {
      tracks_.farther(index, bound);  // this costs much less than refining the foot
      continue;
    }
    index = refine(index, p, options);
    if (last) {  // done now, because later there may be no budget left
      index = crossed = tracks_[index].foot.sides == 0 ? index : cross(index, p, options);
    } else if (tracks_[index].foot.sides != 0) {
      crossSeams(index, p, options);
    }
    // The track of the nearest foot may have been merged or dropped meanwhile, and its place used again.
    const bool gone = nearest < 0 || tracks_[nearest].tick != tracks_.tick();
    if (gone || tracks_[index].foot.distance < best) nearest = index;
    best = std::min(best, tracks_[index].foot.distance);
    if (index != nearest && tracks_.isRival(index) && isHopeless(tracks_[index], best)) dropUnlessHeld(index);
  }
  if (nearest < 0) return start;
  if (nearest != crossed) nearest = cross(nearest, p, options);
  if (budget_ <= 0 && mayBeNearer(nearest, part, p)) tracks_[nearest].foot.converged = false;
  return nearest;
}

/// True if another track may have a nearer foot, although the evaluations of this tick have not found it.
bool Tracer::mayBeNearer(int nearest, int part, const Vector3d& p) const noexcept {
  const double best = tracks_[nearest].foot.distance;
  return std::any_of(tracks_.active().begin(), tracks_.active().end(), [&](int index) {
    const Track& t = tracks_[index];
    if (index == nearest || (part >= 0 && t.part != part) || !(tracks_.atLeast(index) < best)) return false;
    const bool known = t.tick == tracks_.tick() && t.foot.converged;
    return !known && model_.patch(t.patch).atLeast(p) < best;
  });
}

/// True if a rival cannot become the nearest before the next search, or if it has reached a side beyond which the
/// neighbouring patch follows this foot.
bool Tracer::isHopeless(const Track& rival, double best) const noexcept {
  return rival.foot.distance > best + Model::kSoon || model_.patch(rival.patch).continuesBeyond(rival.foot.sides);
}

}  // namespace hapticd::trace
