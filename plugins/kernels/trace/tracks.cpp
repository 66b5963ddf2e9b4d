// SPDX-License-Identifier: MIT
#include "kernels/trace/tracks.hpp"

#include <algorithm>

namespace hapticd::trace {
namespace {

using Eigen::Array2d;

/// [m] The distance in a record was true when its search began, and the probe has moved since. For the first record
/// after clear(), the probe is assumed to have moved by at most this distance: 10 ms at 2 m/s. For later records, the
/// path since the previous results arrived is used, see noteSearch().
constexpr double kWayOfOldRecord = 0.02;
/// If the (u, v) of a record and of a followed foot differ by less than this share of the range, Newton's method leads
/// from the record to that foot.
constexpr double kSameRecord = 0.02;
/// Two refined feet are the same if they are closer than this in (u, v), relative to the range, or in space [m].
constexpr double kSameFoot = 1e-5, kSamePoint = 1e-8;

}  // namespace

Tracks::Tracks(const Model& model)
    : model_(model), patch_count_(model.patchCount()), tracks_(static_cast<std::size_t>(patch_count_ + kRivals)) {
  active_.reserve(tracks_.size());
  key_.reserve(tracks_.size());
  for (int i = 0; i < patch_count_; ++i) {
    (*this)[i].patch = i;
    (*this)[i].part = model.part(model.patch(i).shell);
  }
  clear();
}

void Tracks::append(int index, double bound) noexcept {
  Track& t = (*this)[index];
  t.slot = static_cast<int>(active_.size());
  active_.push_back(index);
  key_.push_back(bound);
}

void Tracks::offer(int patch, const Array2d& uv, double distance, const Probe& probe, bool asked) noexcept {
  noteSearch();
  const Patch& piece = model_.patch(patch);
  const Array2d inside = uv.max(piece.lo).min(piece.hi);
  const double bound = way_told_before_ + std::max(0.0, distance);
  Track& first = (*this)[patch];
  first.asked = first.asked || asked;
  if (first.slot < 0) {
    append(patch, bound);
    set(patch, inside, bound);
    return;
  }
  // a foot that is too far away, or that is outside this patch and so belongs to another patch of the surface
  if (distance > probe.best + Model::kSoon || (inside != uv).any()) return;
  if (follows(patch, inside, bound, probe)) return;
  for (int i = patch; i >= 0; i = (*this)[i].rival)
    if ((*this)[i].touched < told_before_ && !(*this)[i].held) return set(i, inside, bound);
  // If the distance falls beyond a common side, the neighbour has its own record of that minimum.
  if (!(distance < probe.best) && piece.continuesBeyond(piece.sidesAt(inside))) return;
  if (const Track* rival = newRival(patch)) set(static_cast<int>(rival - tracks_.data()), inside, bound);
}

void Tracks::follow(int patch, const Array2d& uv) noexcept {
  if ((*this)[patch].slot >= 0) return;
  append(patch, way_);
  set(patch, uv, way_);
}

void Tracks::restart(int patch, const Array2d& uv) noexcept {
  if (const Track* room = newRival(patch)) {
    Track& rival = (*this)[static_cast<int>(room - tracks_.data())];
    const Track& first = (*this)[patch];
    rival.at = first.at;
    rival.foot = first.foot;
    rival.touched = first.touched;
    key_[static_cast<std::size_t>(rival.slot)] = key_[static_cast<std::size_t>(first.slot)];
  }
  set(patch, uv, way_);
}

/// Records that this tick brings results of a search. `way_told_before_` becomes the length of the probe's path at the
/// tick in which the previous results arrived. The search of the new results began after that tick, because the results
/// of one search arrive in one tick (sim/proximity.cpp), unless there are more than a tick takes (1024). Of those that
/// arrive later, the bounds are then too large by the path in between, 2 mm at most with a hand of 2 m/s at 1 kHz. This
/// stays: a tick has no time for more records, and nothing distinguishes a late record from one of the next search. If
/// records in the tick after were always taken for late ones, the bounds would be looser where searches come in each
/// tick, and recordings of such runs would not replay.
void Tracks::noteSearch() noexcept {
  if (told_ == tick_) return;
  told_before_ = told_;
  way_told_before_ = way_told_;
  told_ = tick_;
  way_told_ = way_;
}

void Tracks::set(int index, const Array2d& uv, double bound) noexcept {
  Track& t = (*this)[index];
  t.at.uv = uv;
  t.at.known = Iterate::Known::kParameters;
  t.touched = tick_;
  key_[static_cast<std::size_t>(t.slot)] = bound;
}

/// True if a record leads to a foot of the patch that is followed already, or to another record. It replaces an older
/// record, and one of the same search that is farther away: beside a hairline fold of a border two feet may be that
/// near to each other.
bool Tracks::follows(int patch, const Array2d& uv, double bound, const Probe& probe) noexcept {
  const Array2d range = model_.patch(patch).hi - model_.patch(patch).lo;
  for (int i = patch; i >= 0; i = (*this)[i].rival) {
    Track& t = (*this)[i];
    if (!((uv - t.at.uv).abs() < kSameRecord * range).all()) continue;
    const bool computed = t.at.known != Iterate::Known::kParameters, of_this_search = t.touched == tick_;
    if (computed && isCertainlyFarther(i, uv, bound, probe)) continue;
    t.touched = tick_;
    if (!computed && (!of_this_search || bound < key_[static_cast<std::size_t>(t.slot)])) set(i, uv, bound);
    return true;
  }
  return false;
}

/// True if a followed foot is farther from the probe than the place of a record. The distance that came with the record
/// may be a lower bound, so where it leaves a doubt, the surface is evaluated.
bool Tracks::isCertainlyFarther(int index, const Array2d& uv, double bound, const Probe& probe) const noexcept {
  constexpr double kSlack = 1e-9;  // [m]
  const double least = atLeast(index) - kSlack;
  if (!probe.known || !(bound - way_ < least)) return false;
  spline::SurfacePoint at;
  model_.patch((*this)[index].patch).surface.evaluate1(uv[0], uv[1], at);
  return (at.S - probe.p).norm() < least;
}

void Tracks::keepAsRival(int patch, const Iterate& at, const LocalFoot& foot) noexcept {
  Track* rival = newRival(patch);
  if (rival == nullptr) return;
  rival->at = at;
  rival->foot = foot;
  refined(static_cast<int>(rival - tracks_.data()));
}

int Tracks::put(int patch, const Iterate& at, const LocalFoot& foot) noexcept {
  int index = patch;
  if ((*this)[patch].slot < 0) {
    append(patch, way_);
  } else {
    for (int i = patch; i >= 0; i = (*this)[i].rival)
      if ((*this)[i].tick == tick_ && isSame(patch, (*this)[i].foot, foot)) return i;
    if (const Track* room = newRival(patch)) index = static_cast<int>(room - tracks_.data());
  }
  (*this)[index].at = at;
  (*this)[index].foot = foot;
  refined(index);
  return index;
}

/// Returns an unused rival, or else the rival that has not been used for the longest time, or null if all were used in
/// this tick or hold contacts.
Track* Tracks::newRival(int patch) noexcept {
  int index = patch_count_;
  for (int i = patch_count_; i < patch_count_ + kRivals && (*this)[index].slot >= 0; ++i)
    if ((*this)[i].slot < 0 || (*this)[index].held || (!(*this)[i].held && (*this)[i].touched < (*this)[index].touched))
      index = i;
  Track& rival = (*this)[index];
  if (rival.slot >= 0 && (rival.held || rival.touched == tick_)) return nullptr;
  drop(index);
  Track& first = (*this)[patch];
  rival.patch = patch;
  rival.tick = 0;
  rival.at.known = Iterate::Known::kParameters;
  rival.asked = false;
  rival.part = first.part;
  rival.rival = first.rival;
  first.rival = index;
  append(index, way_);
  return &rival;
}

void Tracks::drop(int index) noexcept {
  Track& t = (*this)[index];
  if (t.slot < 0) return;
  if (isRival(index)) {
    int before = t.patch;
    while ((*this)[before].rival != index) before = (*this)[before].rival;
    (*this)[before].rival = t.rival;
  } else {
    while (t.rival >= 0) drop(t.rival);
  }
  const auto slot = static_cast<std::size_t>(t.slot);
  active_[slot] = active_.back();
  key_[slot] = key_.back();
  (*this)[active_[slot]].slot = t.slot;
  active_.pop_back();
  key_.pop_back();
  t.slot = t.rival = -1;
  t.tick = 0;
  t.at.known = Iterate::Known::kParameters;
  t.asked = t.held = false;
}

/// True if two feet on one patch are the same.
bool Tracks::isSame(int patch, const LocalFoot& one, const LocalFoot& other) const noexcept {
  const Array2d range = model_.patch(patch).hi - model_.patch(patch).lo;
  return ((one.uv - other.uv).abs() < kSameFoot * range).all() || (one.S - other.S).norm() < kSamePoint;
}

int Tracks::merge(int index) noexcept {
  const int first = (*this)[index].patch;
  for (int i = first; i >= 0; i = (*this)[i].rival) {
    if (i == index || (*this)[i].tick != tick_) continue;
    if (!isSame(first, (*this)[i].foot, (*this)[index].foot)) continue;
    const int kept = isRival(i) ? index : i, gone = isRival(i) ? i : index;
    if ((*this)[gone].foot.distance < (*this)[kept].foot.distance) {
      (*this)[kept].at = (*this)[gone].at;
      (*this)[kept].foot = (*this)[gone].foot;
      refined(kept);
    }
    (*this)[kept].held = (*this)[kept].held || (*this)[gone].held;
    drop(gone);
    return kept;
  }
  return index;
}

void Tracks::clear() noexcept {
  while (!active_.empty()) drop(active_.back());
  way_ = 0;
  told_ = told_before_ = tick_;
  way_told_ = way_told_before_ = -kWayOfOldRecord;
}

void Tracks::countAnew() noexcept {
  for (double& key : key_) key -= way_;
  way_told_ -= way_;
  way_told_before_ -= way_;
  way_ = 0;
}

}  // namespace hapticd::trace
