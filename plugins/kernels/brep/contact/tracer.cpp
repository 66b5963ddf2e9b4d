// SPDX-License-Identifier: MIT
#include "kernels/brep/contact/tracer.hpp"

#include <algorithm>
#include <array>

#include "kernels/brep/contact/next_faces.hpp"

namespace hapticd::brep {

using contact::Foot;
using contact::FootStatus;
using Eigen::Vector3d;

namespace {
constexpr double kFarthest = 1e12;  ///< [m] from farther away, distances to a part have too few digits
constexpr int kMostAround = 64;     ///< most bodies whose boxes contain the probe that one tick looks at
constexpr int kMostSearched = 8;    ///< most of them that it searches; the next ticks search the others
}  // namespace

/// Lets contact::ContactState query the part at the probe of this tick.
class Tracer::Faces {
 public:
  Faces(Tracer& tracer, const Vector3d& p) : tracer_(tracer), p_(p) {}

  contact::Followed follow(double side, Foot& foot) noexcept {
    const contact::Followed how = tracer_.follow(side, p_, foot);
    const bool on = how == contact::Followed::kOn && side * foot.behind > foot.aside;
    if (on || how == contact::Followed::kLost) [[likely]]
      return how;
    return goOnBehindNext(side, foot) || goOnFlushBody(side, foot) ? contact::Followed::kOn : how;
  }
  Foot nearest() noexcept { return tracer_.nearestOnce(p_); }
  bool enter(const contact::PathStart& from, contact::Sides sides, double& side) noexcept {
    return tracer_.enter(from.point, p_, sides, side) ||
           (sides == contact::Sides::kBoth && cameThroughGap(from.point, side));
  }
  void holdNearest() noexcept { tracer_.held_ = tracer_.nearest_; }
  void release() noexcept { tracer_.held_.place = kNone; }

 private:
  /// Moves a held foot on to the next face if the probe is behind that one. Else returns false: the contact has ended.
  [[gnu::cold, gnu::noinline]] bool goOnBehindNext(double side, Foot& foot) noexcept {
    if (!isBehindNext(side)) return false;
    if (!tracer_.slideAside(side, p_, foot)) {
      holdNearest();
      foot = nearest();
    }
    foot.begins = true;
    return true;
  }

  /// Moves a held foot that has come to an edge on to another body, if that one is flush. Else returns false. For
  /// friction, the contact does not begin anew.
  [[gnu::cold, gnu::noinline]] bool goOnFlushBody(double side, Foot& foot) noexcept {
    return tracer_.model().placements().size() > 1 && tracer_.goOnFlush(side, p_, foot);
  }

  /// True if the probe, which has come out in front of the held face or over an edge of it, is behind the next one, as
  /// may be beside a sharp edge or a re-entrant corner.
  bool isBehindNext(double side) noexcept {
    const Held &held = tracer_.held_, &next = tracer_.nearest_;
    if (!isBehind(side) || next.place != held.place) return false;
    // Another layer of a rolled sheet may be nearer. The probe was not in front of that one.
    const Placement& place = tracer_.model().placements()[held.place];
    const Body& body = tracer_.model().part().bodies[place.body];
    return place.solid || areTogether(tracer_.model(), body, held.face, next.face);
  }

  /// True if the probe was on the given side of a solid and is now on the other, although its path met no face: the
  /// faces of a file may leave gaps within its tolerance. Holds the nearest foot then.
  bool cameThroughGap(const Vector3d& from, double side) noexcept {
    constexpr double kLeast = 1e-8;  // [m] nearer to a face, rounding decides on the side
    if (!isBehind(side) || !(tracer_.felt_.distance > kLeast)) return false;
    if (!tracer_.mayBeThroughGap((p_ - from).norm())) return false;
    holdNearest();
    return true;
  }

  /// True if the probe is certainly behind its nearest foot, seen from the given side. Beside a free edge it is neither
  /// in front nor behind.
  bool isBehind(double side) noexcept {
    const Foot& foot = tracer_.nearestOnce(p_);
    return foot.status == FootStatus::kNearest && !(foot.aside > 0) && side * foot.behind > 0;
  }

  Tracer& tracer_;
  const Vector3d& p_;
};

Tracer::Tracer(const Model& model) : search_(model), outside_(model.placements().size()) {}

void Tracer::reset() noexcept {
  search_.reset();
  outside_.reset();
  held_.place = kNone;
  contact_ = {};
  has_last_ = false;
}

void Tracer::forgetContact() noexcept {
  contact_.forget();
  has_last_ = false;
}

void Tracer::popThrough() noexcept {
  held_.place = kNone;
  felt_.status = FootStatus::kIdle;  // the probe may already be beyond a thin wall, on the side from which it came
  contact_.popThrough(last_p_);
}

Tracer::Held Tracer::heldAt(const Nearest& nearest) const noexcept {
  return {nearest.place, faceOf(model(), nearest.hit, held_.face), nearest.hit};
}

/// A probe that is outside the nearest body may be inside another one whose surface is farther away. Then `foot`
/// becomes the foot on that body, or on the one with the greatest depth if there are several. Returns false if that is
/// not certain: a search was not, or some bodies are left for the next ticks.
bool Tracer::preferDeepestAround(const Vector3d& p, Foot& foot) noexcept {
  std::array<std::uint32_t, kMostAround> around;
  const int count = search_.around(p, around.data(), kMostAround);
  bool certain = count < kMostAround;
  for (int i = 0, searched = 0; i < count; ++i) {
    const std::uint32_t place = around[static_cast<std::size_t>(i)];
    if (place == nearest_.place && !(foot.depth > 0)) continue;
    if (outside_.isOutside(place, p)) continue;
    if (++searched > kMostSearched) return false;
    const Nearest other = search_.nearestOf(place, kNone, p, Hit{}, budget_);
    foot.evaluations += other.elements;
    certain = certain && other.proved;
    if (!other.found()) continue;
    const Held held = heldAt(other);
    const Foot inside = describe(model(), place, held.hit, held.face, p);
    if (!(inside.depth > 0) && other.proved) outside_.keep(place, p, other.distance());
    if (!(inside.depth > std::max(foot.depth, 0.0))) continue;
    const int evaluations = foot.evaluations;
    foot = inside;
    foot.evaluations = evaluations;
    nearest_ = held;
  }
  return certain;
}

/// Returns the nearest foot of all bodies, or a foot at which the probe is deeper inside.
Foot Tracer::nearestFelt(const Vector3d& p) noexcept {
  const Nearest& found = search_.nearest(p, budget_);
  Foot foot;
  if (!found.found()) {
    foot.status = FootStatus::kDegraded;
    return foot;
  }
  nearest_ = heldAt(found);
  foot = describe(model(), nearest_.place, nearest_.hit, nearest_.face, p);
  bool proved = found.proved;
  foot.evaluations = found.elements;
  foot.residual = proved ? 0 : std::max(0.0, foot.distance - found.others);
  if (model().placements().size() > 1 && !(foot.depth > 0)) proved = preferDeepestAround(p, foot) && proved;
  foot.status = proved ? FootStatus::kNearest : FootStatus::kDegraded;
  return foot;
}

const Foot& Tracer::nearestOnce(const Vector3d& p) noexcept {
  if (!has_felt_) felt_ = nearestFelt(p);
  has_felt_ = true;
  return felt_;
}

Foot Tracer::nearest(const Vector3d& p, const SearchBudget& budget) noexcept {
  budget_ = budget;
  return nearestFelt(p);
}

/// True if a path of length `way` [m] to the probe may have led through a gap of a solid: the nearest foot is certain,
/// on the same solid as in the last tick, and no farther than a gap of the file is wide.
bool Tracer::mayBeThroughGap(double way) const noexcept {
  if (!has_last_ || felt_.status != FootStatus::kNearest || nearest_.place != last_place_) return false;
  return model().placements()[nearest_.place].solid && felt_.distance <= way + model().part().tolerance;
}

void Tracer::count(const Foot& foot) noexcept {
  if (foot.status == FootStatus::kNearest) ++counts_.nearest;
  if (foot.status == FootStatus::kHeld) ++counts_.held;
  if (foot.status == FootStatus::kDegraded) ++counts_.degraded;
}

Foot Tracer::step(const Vector3d& p, const contact::ContactRule& rule, const SearchBudget& budget) noexcept {
  Foot foot;
  if (!(p.lpNorm<1>() <= kFarthest)) {  // also true for NaN
    foot.status = FootStatus::kInvalid;
    return foot;
  }
  budget_ = budget;
  has_felt_ = false;
  last_place_ = felt_.status == FootStatus::kNearest ? nearest_.place : kNone;
  Faces faces(*this, p);
  const double side = contact_.held() ? 0 : contact_.side();
  foot = contact_.step(faces, has_last_ ? last_p_ : p, p, rule);
  // A side does not change without a contact. In a gap between two faces, the steps of a slow probe are shorter than
  // the distance to any face, so no path was tested. The next path is.
  const bool holds = rule.sides == contact::Sides::kBoth && rule.hysteresis > 0;
  const bool changed = holds && !contact_.held() && side * contact_.side() < 0;
  if (changed && mayBeThroughGap((p - last_p_).norm())) contact_.popThrough(p);
  last_p_ = p;
  has_last_ = true;
  if (contact_.held() && !foot.on_edge)
    last_normal_ = foot.normal, last_foot_ = foot.point;
  else if (!contact_.held() || foot.begins)
    last_normal_.setZero();
  count(foot);
  return foot;
}

}  // namespace hapticd::brep
