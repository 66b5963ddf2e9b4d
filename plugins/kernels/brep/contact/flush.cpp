// SPDX-License-Identifier: MIT
/// Leads a held contact from one body onto the next, where their surfaces are flush.
#include <algorithm>
#include <array>

#include "kernels/brep/contact/tracer.hpp"

namespace hapticd::brep {

using contact::Followed;
using contact::Foot;
using Eigen::Vector3d;

/// Moves a contact, which has come to an edge of its body, to the face of another body that goes on there without a
/// step. Otherwise the probe would be in that body, and would seem to have come in through the wall that the first body
/// covers: this hidden wall would stop the hand, and the surface would let go of it. Returns false, and leaves the
/// contact, if there is no such face.
bool Tracer::goOnFlush(double side, const Vector3d& p, Foot& foot) noexcept {
  constexpr int kMostBodies = 8;
  constexpr double kStep = 0.25;    // a step is flush if it is lower than this share of the way of the tick
  constexpr double kBeside = 1e-3;  // share of the way of the tick: on the edge itself, rounding decides on the face
  constexpr double kAlong = 0.8;    // least cosine between the normals of the two faces
  const Held before = held_;
  if (!model().placements()[before.place].solid || !(last_normal_.squaredNorm() > 0)) return false;
  const double depth = last_normal_.dot(last_foot_ - p);
  if (!(depth > 0)) return false;  // it came out in front of the face
  const Vector3d way = p - last_p_, beside = p + kBeside * way;
  const Vector3d on = p + way + depth * last_normal_;  // where the surface would go on, a tick ahead
  const double flush = std::max(model().part().tolerance, kStep * way.norm());
  std::array<std::uint32_t, kMostBodies> around;
  const int count = std::min(search_.around(p, around.data(), kMostBodies), kMostBodies);
  for (int i = 0; i < count; ++i) {
    const std::uint32_t place = around[static_cast<std::size_t>(i)];
    if (place == before.place || !model().placements()[place].solid) continue;
    const Nearest found = search_.nearestOf(place, kNone, on, Hit{}, budget_);
    if (!found.found() || !(found.distance() <= flush)) continue;
    const Held next = heldAt(found);
    if (!(side * describe(model(), place, next.hit, next.face, on).normal.dot(last_normal_) > kAlong)) continue;
    for (const Vector3d& at : {p, beside}) {
      held_ = next;
      if (follow(side, at, foot) == Followed::kOn && contact::seenFrom(foot, side).depth > 0) return true;
    }
    held_ = before;
  }
  return false;
}

}  // namespace hapticd::brep
