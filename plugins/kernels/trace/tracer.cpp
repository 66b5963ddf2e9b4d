#include "kernels/trace/tracer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hapticd::trace {
namespace {

using Eigen::Array2d;
using Eigen::Vector3d;

constexpr double kFarthest = 1e150;       ///< [m] squares of coordinates beyond overflow
constexpr double kLongestWay = 1e4;       ///< [m] then keys are counted from zero again, to keep their digits
constexpr double kNeighbourReach = 0.15;  ///< [m] a neighbour nobody asked for is dropped beyond
/// [m] A record tells the distance from where the probe was when the search began: 10 ms earlier at 2 m/s.
constexpr double kRecordAge = 0.02;
/// A record whose (u, v) differ by less than this share of the range leads Newton to the foot that is tracked already.
constexpr double kSameFoot = 0.02;
constexpr int kMaxCrossings = 4;  ///< of sides in one tick

}  // namespace

Tracer::Tracer(const Model& model) : model_(model), tracks_(static_cast<std::size_t>(model.patchCount())) {
  active_.reserve(tracks_.size());
  key_.reserve(tracks_.size());
}

void Tracer::activate(int surface, double u, double v, double distance) noexcept {
  if (surface < 0 || surface >= model_.surfaceCount() || !std::isfinite(u) || !std::isfinite(v)) return;
  for (int i = model_.firstPatch(surface); i < model_.lastPatch(surface); ++i) start(i, {u, v}, distance, true);
}

void Tracer::start(int patch, const Array2d& uv, double distance, bool asked) noexcept {
  const Patch& piece = model_.patch(patch);
  Track& t = track(patch);
  const Array2d inside = uv.max(piece.lo).min(piece.hi);
  const double bound = way_ + std::max(0.0, distance - kRecordAge);
  t.asked = t.asked || asked;
  if (t.slot < 0) {
    t.slot = static_cast<int>(active_.size());
    t.at.uv = inside;
    t.at.valid = t.has_candidate = false;
    active_.push_back(patch);
    key_.push_back(bound);
    return;
  }
  if (((inside - t.at.uv).abs() < kSameFoot * (piece.hi - piece.lo)).all()) return;
  t.candidate = inside;
  t.has_candidate = true;
  double& key = key_[static_cast<std::size_t>(t.slot)];
  key = std::min(key, bound);
}

void Tracer::deactivate(int surface) noexcept {
  if (surface < 0 || surface >= model_.surfaceCount()) return;
  for (int i = model_.firstPatch(surface); i < model_.lastPatch(surface); ++i) drop(i);
  const bool asked = std::any_of(active_.begin(), active_.end(), [this](int i) { return track(i).asked; });
  while (!asked && !active_.empty()) drop(active_.back());
}

void Tracer::drop(int patch) noexcept {
  Track& t = track(patch);
  if (t.slot < 0) return;
  const auto slot = static_cast<std::size_t>(t.slot);
  active_[slot] = active_.back();
  key_[slot] = key_.back();
  track(active_[slot]).slot = t.slot;
  active_.pop_back();
  key_.pop_back();
  t.slot = -1;
  t.tick = 0;
  t.at.valid = t.has_candidate = t.asked = false;
  if (nearest_ == patch) nearest_ = -1;
}

void Tracer::reset() noexcept {
  while (!active_.empty()) drop(active_.back());
  has_last_ = false;
  way_ = 0;
}

bool Tracer::active(int surface) const noexcept {
  if (surface < 0 || surface >= model_.surfaceCount()) return false;
  for (int i = model_.firstPatch(surface); i < model_.lastPatch(surface); ++i)
    if (track(i).slot >= 0) return true;
  return false;
}

Foot Tracer::step(const Vector3d& p, const TraceOptions& options) noexcept {
  Foot foot;
  if (!(p.array().abs() <= kFarthest).all()) {  // also false for not-a-number
    foot.status = TraceStatus::kInvalid;
    return foot;
  }
  goneTo(p);
  if (active_.empty()) return foot;
  ++tick_;
  budget_ = std::max(options.max_evaluations, 1);
  if (options.method == Method::kDirect) {
    stepDirect(p, options.iterations);
  } else {
    stepNewton(p, std::max(options.tolerance, 0.0));
  }
  if (nearest_ < 0) return foot;
  foot = describe(nearest_, p);
  foot.evaluations = std::max(options.max_evaluations, 1) - budget_;
  return foot;
}

void Tracer::goneTo(const Vector3d& p) noexcept {
  if (has_last_) way_ += (p - last_p_).norm();
  last_p_ = p;
  has_last_ = true;
  if (!(way_ > kLongestWay)) return;
  for (double& key : key_) key -= way_;
  way_ = 0;
}

/// The active patch that could hold a foot nearer than `best` and has the smallest lower bound; -1: none.
int Tracer::mostPromising(double best) const noexcept {
  double lowest = best + way_;
  int found = -1;
  for (std::size_t slot = 0; slot < key_.size(); ++slot) {
    if (!(key_[slot] < lowest) || track(active_[slot]).tick == tick_) continue;
    lowest = key_[slot];
    found = active_[slot];
  }
  return found;
}

void Tracer::stepDirect(const Vector3d& p, int iterations) noexcept {
  double best = std::numeric_limits<double>::infinity();
  nearest_ = -1;
  for (int patch : active_) {
    Track& t = track(patch);
    if (t.has_candidate) {
      t.has_candidate = false;
      const double here = t.at.valid ? (t.at.E.S - p).norm() : std::numeric_limits<double>::infinity();
      Iterate other{t.candidate, {}, false};
      const LocalFoot foot = directFoot(model_.patch(patch), p, other, 0);
      if (foot.distance < here) t.at = other;
    }
    t.foot = directFoot(model_.patch(patch), p, t.at, iterations);
    budget_ -= t.foot.evaluations;
    store(patch);
    if (!(t.foot.distance < best)) continue;
    best = t.foot.distance;
    nearest_ = patch;
  }
}

void Tracer::stepNewton(const Vector3d& p, double tolerance) noexcept {
  double best = std::numeric_limits<double>::infinity();
  for (int patch = nearest_ >= 0 ? nearest_ : mostPromising(best); patch >= 0 && budget_ > 0;
       patch = mostPromising(best)) {
    refine(patch, p, tolerance);
    if (!(track(patch).foot.distance < best)) continue;
    best = track(patch).foot.distance;
    nearest_ = patch;
  }
  if (nearest_ >= 0) cross(p, tolerance);
}

/// Keeps the new foot's distance as the bound for the ticks to come.
void Tracer::store(int patch) noexcept {
  Track& t = track(patch);
  t.tick = tick_;
  key_[static_cast<std::size_t>(t.slot)] = t.foot.distance + way_;
}

void Tracer::refine(int patch, const Vector3d& p, double tolerance) noexcept {
  Track& t = track(patch);
  t.foot = newtonFoot(model_.patch(patch), p, t.at, tolerance, budget_);
  budget_ -= t.foot.evaluations;
  if (t.has_candidate && budget_ > 0) {
    t.has_candidate = false;
    tryFrom(patch, t.candidate, p, tolerance);
  }
  store(patch);
}

/// Replaces the foot of a patch by the one found from (u, v) if that is nearer.
bool Tracer::tryFrom(int patch, const Array2d& uv, const Vector3d& p, double tolerance) noexcept {
  if (budget_ <= 0) return false;
  Track& t = track(patch);
  Iterate other{uv, {}, false};
  const LocalFoot foot = newtonFoot(model_.patch(patch), p, other, tolerance, budget_);
  budget_ -= foot.evaluations;
  if (!(foot.distance < t.foot.distance)) return false;
  t.foot = foot;
  t.at = other;
  store(patch);
  return true;
}

/// Follows the nearest foot across the sides that it meets, while that brings it nearer.
void Tracer::cross(const Vector3d& p, double tolerance) noexcept {
  for (int i = 0; i < kMaxCrossings && budget_ > 0; ++i) {
    const int from = nearest_;
    const SideMask sides = track(from).foot.sides;
    bool nearer = false;
    for (int side = 0; side < kSides && !nearer; ++side)
      if (sides & bit(side)) nearer = crossSide(from, side, p, tolerance);
    if (!nearer) return;
  }
}

bool Tracer::crossSide(int patch, int side, const Vector3d& p, double tolerance) noexcept {
  const Patch& piece = model_.patch(patch);
  const Side& edge = piece.sides[static_cast<std::size_t>(side)];
  const LocalFoot& foot = track(patch).foot;
  if (edge.kind == SideKind::kFree) return false;
  if (edge.kind == SideKind::kPole) return leavePole(patch, side, p, tolerance);
  const double fraction = piece.fractionOn(side, foot.uv);
  const Array2d there = model_.patch(edge.patch).onSide(edge.side, edge.flipped ? 1 - fraction : fraction);
  if (edge.patch == patch) return tryFrom(patch, there, p, tolerance);
  Track& next = track(edge.patch);
  const double best = foot.distance;
  if (next.slot < 0) start(edge.patch, there, 0, false);
  if (next.tick != tick_) refine(edge.patch, p, tolerance);
  // The common side belongs to the neighbour too: if its foot is farther away, it sits in another valley.
  if (next.foot.distance > best + tolerance) tryFrom(edge.patch, there, p, tolerance);
  const bool nearer = next.foot.distance < best;
  if (nearer) nearest_ = edge.patch;
  if (!next.asked && next.foot.distance > kNeighbourReach) drop(edge.patch);
  return nearer;
}

bool Tracer::leavePole(int patch, int side, const Vector3d& p, double tolerance) noexcept {
  constexpr double kOutward = 1e-9;  // cosine: rays at right angles to the probe lead no nearer
  const Patch& piece = model_.patch(patch);
  const PoleFan& fan = model_.pole(piece.sides[static_cast<std::size_t>(side)].pole);
  const Track& t = track(patch);
  const Vector3d r = p - t.foot.S;
  int best = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < PoleFan::kRays; ++i) {
    const double gain = r.dot(fan.direction[static_cast<std::size_t>(i)]);
    if (!(gain > most)) continue;
    most = gain;
    best = i;
  }
  if (!(most > kOutward * r.norm())) return false;
  const int axis = Patch::axisOf(side);
  const double range = piece.hi[axis] - piece.lo[axis];
  const double speed = (axis == 0 ? t.at.E.Su : t.at.E.Sv).norm();
  const double inward = std::clamp(most / std::max(speed, 1e-300), 1e-6 * range, 0.25 * range);
  Array2d uv;
  uv[axis] = side % 2 == 0 ? piece.lo[axis] + inward : piece.hi[axis] - inward;
  uv[1 - axis] = fan.along[static_cast<std::size_t>(best)];
  return tryFrom(patch, uv, p, tolerance);
}

}  // namespace hapticd::trace
