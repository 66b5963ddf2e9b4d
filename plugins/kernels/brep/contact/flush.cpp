// SPDX-License-Identifier: MIT
/// Leads a held contact from one body onto the next, where their surfaces are flush.
#include <algorithm>
#include <array>

#include "kernels/brep/contact/tracer.hpp"

namespace hapticd::brep {

using contact::Followed;
using contact::Foot;
using Eigen::Vector3d;

namespace {
constexpr double kLow = 1e-5;  ///< [m] no hand feels a lower step
}  // namespace

/// Finds the bodies whose boxes the probe has pressed through at a joint, since bodies may lie on top of each other.
/// Returns how many there are.
int Tracer::bodiesAt(const Joint& joint, Places& places) const noexcept {
  constexpr int kLevels = 4;
  int count = 0;
  for (int level = 0; level <= kLevels; ++level) {
    const double below = level > 0 ? joint.depth * level / kLevels : std::min(joint.up, joint.depth);
    Places around;
    const int cap = static_cast<int>(around.size());
    const int found = std::min(search_.around(joint.on - below * last_normal_, around.data(), cap), cap);
    for (int i = 0; i < found && count < cap; ++i) {
      const std::uint32_t place = around[static_cast<std::size_t>(i)];
      const auto end = places.begin() + count;
      if (place == held_.place || !model().placements()[place].solid || std::find(places.begin(), end, place) != end)
        continue;
      places[static_cast<std::size_t>(count++)] = place;
    }
  }
  return count;
}

/// Returns the face of another body that goes on from the held one at a place ahead; none if it has a step there.
/// @param distance becomes the distance [m] of the body from that place
Tracer::Held Tracer::faceAhead(std::uint32_t place, double side, const Joint& joint, const Vector3d& at,
                               double& distance) noexcept {
  constexpr double kAlong = 0.8;  // least cosine between the normals of the two faces
  const Nearest found = search_.nearestOf(place, kNone, at, Hit{}, budget_);
  distance = found.distance();
  if (!found.found()) return {};
  const Held next = heldAt(found);
  const Foot foot = contact::seenFrom(describe(model(), place, next.hit, next.face, at), side);
  const bool low = distance <= (foot.depth > 0 ? joint.up : std::max(joint.up, joint.depth));
  return low && foot.normal.dot(last_normal_) > kAlong ? next : Held{};
}

/// Holds the face of another body, if it goes on from the held one and the probe is behind it. Else returns false. It
/// is looked for a tick ahead, because the last normal lags on a curved surface; so far ahead that the hidden wall is
/// farther than a step; and, for a narrow body, above the probe.
bool Tracer::goOnTo(std::uint32_t place, double side, const Joint& joint, const Vector3d& p, Foot& foot) noexcept {
  constexpr double kAhead = 4;      // in steps
  constexpr double kBeside = 1e-3;  // share of the way of the tick: on the edge itself, rounding decides on the face
  const double tick = joint.way.norm(), far = std::max(tick, kAhead * joint.up);
  for (const double ahead : {tick, kAhead * kLow, kAhead * joint.up, 0.0}) {
    double distance = 0;
    const Held next = faceAhead(place, side, joint, joint.on + ahead * joint.way.normalized(), distance);
    if (!(distance <= std::max(joint.up, joint.depth) + far)) return false;  // it is so near at none of these places
    for (const Vector3d& at : {p, Vector3d(p + kBeside * joint.way)}) {
      held_ = next;
      if (follow(side, at, foot) == Followed::kOn && contact::seenFrom(foot, side).depth > 0) return true;
    }
  }
  return false;
}

/// Moves a contact, which has come to an edge of its body, to the face of another body that goes on there, flush or by
/// a step down that the probe has pressed through. Otherwise the probe would be in that body, and would seem to have
/// come in through the wall that the first body covers: this hidden wall would stop the hand, and the surface would let
/// go of it. Returns false, and leaves the contact, if there is no such face. A step up has a wall that is not hidden.
bool Tracer::goOnFlush(double side, const Vector3d& p, Foot& foot) noexcept {
  // A step up is none if it is lower than a share of the way of the tick, or than what no hand feels, since parts of a
  // file may be so far off. A hand that presses deep feels it as a small step of the force.
  constexpr double kStep = 0.25, kOfDepth = 0.25;  // shares of the way of the tick and of the depth
  constexpr double kHighest = 1e-4;                // [m] of a step that depends on the depth
  const Held before = held_;
  if (!model().placements()[before.place].solid || !(last_normal_.squaredNorm() > 0)) return false;
  const double depth = last_normal_.dot(last_foot_ - p);
  if (!(depth > 0)) return false;  // it came out in front of the face
  const Vector3d move = p - last_p_, way = move - move.dot(last_normal_) * last_normal_;
  const double up =
      std::max({model().part().tolerance, kLow, kStep * way.norm(), std::min(kOfDepth * depth, kHighest)});
  const Joint joint{p + depth * last_normal_, way, depth, up};
  Places places;
  const int count = bodiesAt(joint, places);
  Held best = before;
  double deepest = 0;
  for (int i = 0; i < count; ++i) {
    Foot found;
    if (!goOnTo(places[static_cast<std::size_t>(i)], side, joint, p, found)) continue;
    const double felt = contact::seenFrom(found, side).depth;
    if (!(felt > deepest)) continue;
    deepest = felt;
    best = held_;
    foot = found;
  }
  held_ = best;
  return deepest > 0;
}

}  // namespace hapticd::brep
