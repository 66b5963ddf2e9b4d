// SPDX-License-Identifier: MIT
/// Measures the energy that loops of 10 and 20 mm give. A shape whose stiffness changes along its surface, but whose
/// force is only k * depth * normal, is no spring: a hand that goes in where it is soft, along below the surface, and
/// out where it is stiff gets energy. In loops of 2 mm the stiffness hardly changes.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/clock.hpp"
#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

constexpr double kTrackStep = 1e-3;                  ///< [m] distance between two places of a track
constexpr size_t kTrackSteps = 60;                   ///< [steps] length of a track
constexpr std::array<size_t, 2> kLoopSteps{10, 20};  ///< [steps] lengths of loops

/// A place at a depth below the surface.
struct Below {
  Vector3d foot = Vector3d::Zero(), normal = Vector3d::Zero();
  double force = 0;  ///< [N] outward
};

/// Places along the surface, kTrackStep apart, at one depth.
using Track = std::vector<Below>;

/// A loop in at the beginning of a track, along it, and out at its end.
struct Loop {
  Track track;
  double depth = 0;     ///< [m]
  double contrast = 0;  ///< the relative difference of the forces at its two ends
};

/// Returns the answer below a foot, or nothing if the surface does not go on smoothly from `last`: at an edge, a held
/// foot, a leap, or a thin place the force may depend on the way.
std::optional<Below> goOn(Subject& subject, const Below& last, const Vector3d& way, double depth) {
  constexpr double kTurn = 0.95, kLeap = 4;  // cosine of the largest turn; multiple of the way or of the depth
  const Answer& answer = subject.step({last.foot - depth * last.normal + way}, kConformanceDt);
  const hsp_contact& c = answer.contacts[0];
  if (answer.status != HSP_OK || !finite(answer) || !(c.depth_m > 0)) return std::nullopt;
  if ((c.flags & HSP_OUT_TRACED) == 0 || (c.flags & (HSP_OUT_EDGE | HSP_OUT_HELD)) != 0) return std::nullopt;
  const Below next{Vector3d(c.point), Vector3d(c.normal), Vector3d(c.force).dot(Vector3d(c.normal))};
  const bool smooth =
      next.normal.dot(last.normal) > kTurn && (next.foot - last.foot).norm() < kLeap * std::max(way.norm(), depth);
  return smooth && std::abs(c.depth_m - depth) < 0.3 * depth ? std::optional(next) : std::nullopt;
}

/// Follows the surface from a place in a direction, at a depth, as far as it goes on smoothly.
Track trackFrom(Subject& subject, const Place& place, Vector3d way, double depth) {
  Track track;
  subject.reset();
  const Vector3d above = place.foot + depth * place.out;
  for (int i = 0; i <= 10; ++i)
    subject.step({above - 0.2 * i * depth * place.out}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
  Below last{place.foot, place.out, 0};
  while (track.size() <= kTrackSteps) {
    const auto next = goOn(subject, last, track.empty() ? Vector3d::Zero().eval() : (kTrackStep * way).eval(), depth);
    if (!next) break;
    track.push_back(last = *next);
    way = (way - way.dot(last.normal) * last.normal).normalized();
  }
  return track;
}

/// [m] Returns the depth of the loops: deeper than a short loop, as a hand presses.
double loopDepth(const Subject& subject, const Place& place) {
  constexpr double kDeep = 3e-3, kOfThrough = 0.6, kOfSize = 0.05;
  const double size = subject.report().size_m, deep = std::min(kDeep, kOfThrough * place.through);
  return size > 0 ? std::min(deep, kOfSize * size) : deep;
}

/// Adds the part of a track with each length of a loop whose forces at both ends differ most.
void addLoops(const Track& track, double depth, std::vector<Loop>& loops) {
  for (const size_t length : kLoopSteps) {
    size_t best = track.size();
    double most = -1;
    for (size_t i = 0; i + length < track.size(); ++i) {
      const double a = track[i].force, b = track[i + length].force;
      const double contrast = std::abs(a - b) / std::max(std::abs(a) + std::abs(b), 1e-9);
      if (contrast > most) most = contrast, best = i;
    }
    if (best == track.size()) continue;
    const auto begin = track.begin() + static_cast<std::ptrdiff_t>(best);
    loops.push_back({Track(begin, begin + static_cast<std::ptrdiff_t>(length) + 1), depth, most});
  }
}

/// The positions of a loop, finely enough to add up the work: in, along at the depth, out, and back above the surface.
std::vector<Vector3d> pathOf(const Track& track, double depth) {
  constexpr int kIn = 40, kBetween = 4, kRest = 5;
  std::vector<Vector3d> path;
  const auto at = [&](const Below& b, double height) -> Vector3d { return b.foot + height * b.normal; };
  const auto line = [&path](const Vector3d& to, int steps) {
    const Vector3d from = path.back();
    for (int i = 1; i <= steps; ++i) path.push_back(from + (to - from) * i / steps);
  };
  const auto rest = [&path] { path.insert(path.end(), kRest, Vector3d(path.back())); };
  path.push_back(at(track.front(), depth));
  line(at(track.front(), -depth), kIn), rest();
  for (size_t i = 1; i < track.size(); ++i) line(at(track[i], -depth), kBetween);
  rest(), line(at(track.back(), depth), kIn);
  for (size_t i = track.size() - 1; i-- > 0;) line(at(track[i], depth), kBetween);
  return path;
}

/// The work of a loop on the hand.
struct Gift {
  double given = 0, moved = 0;  ///< [J] the work, and the sum of its magnitudes
  double share() const { return moved > 0 ? given / moved : 0; }
};

/// Returns the work on a hand that goes along the path.
Gift workOn(Subject& subject, const std::vector<Vector3d>& path) {
  Gift gift;
  subject.reset();
  const double before = subject.energy();
  Vector3d force = Vector3d::Zero();
  for (size_t i = 0; i < path.size(); ++i) {
    const Answer& answer = subject.step({path[i]}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
    const Vector3d now(answer.contacts[0].force);
    const double work = i > 0 ? 0.5 * (force + now).dot(path[i] - path[i - 1]) : 0;
    gift.given += work, gift.moved += std::abs(work), force = now;
  }
  if (!std::isnan(before)) gift.given += subject.energy() - before;
  return gift;
}

/// Returns what a loop gives, in the direction in which it gives more, if that is more than rounding and claimed jumps
/// explain. A texture changes the force by the same size at each depth, so its share falls with the depth; the share
/// of a stiffness that changes does not.
std::optional<Gift> givenBy(Subject& subject, const Loop& loop) {
  constexpr double kLeast = 0.03, kGrows = 0.75, kRounding = 1e-7;  // shares of the energy that was moved; [J]
  const hsp_report& report = subject.report();
  const double jump = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  const double jumps = jump * (2 * loop.depth + kTrackStep * static_cast<double>(loop.track.size()));
  for (const bool back : {false, true}) {
    Track way = loop.track;
    if (back) std::reverse(way.begin(), way.end());
    const Gift deep = workOn(subject, pathOf(way, loop.depth));
    if (deep.share() < kLeast || deep.given < kRounding + jumps) continue;
    const Gift half = workOn(subject, pathOf(way, loop.depth / 2));
    if (half.share() >= kLeast && deep.share() > kGrows * half.share()) return deep;
  }
  return std::nullopt;
}

std::string objectionTo(const Loop& loop, const Gift& gift) {
  const Track& track = loop.track;
  constexpr double kSame = 0.02;  // relative difference of stiffness that is none
  const double length = kTrackStep * static_cast<double>(track.size() - 1);
  const double here = track.front().force / loop.depth, there = track.back().force / loop.depth;
  const bool same = std::abs(here - there) < kSame * (std::abs(here) + std::abs(there));
  return placed(
      "a loop in, " + text(length * 1e3) + " mm along at a depth of " + roughly(loop.depth * 1e3) +
          " mm, and out gave " + roughly(gift.given * 1e3) + " mJ to the hand, " + roughly(100 * gift.share()) +
          " % of what it exchanged: a hand that moves in loops would be driven; it is " + text(std::round(here)) +
          " N/m stiff here and " + text(std::round(there)) + " N/m at " + text(track.back().foot) +
          (same ? "; look at forces along the surface, and at those that depend on the velocity"
                : "; expected the force of a spring energy U (force = -grad U): where the stiffness k changes "
                  "along the surface, U = k depth^2 / 2 needs the force -depth^2 / 2 times the slope of k along "
                  "the surface too (without HSP_R_PUSHES), or k must not change"),
      track.front().foot);
}

/// Finds the loops whose ends differ most in stiffness, at all places and in all directions.
std::vector<Loop> loopsOf(Subject& subject, const std::vector<Place>& places) {
  constexpr Nanoseconds kPatience = 1'000'000'000;  // [ns] a slow shape is not followed from all of its places
  const Nanoseconds end = monotonicNow() + kPatience;
  std::vector<Loop> loops;
  for (const Place& place : places) {
    const Vector3d u = place.out.unitOrthogonal(), v = place.out.cross(u);
    const double depth = loopDepth(subject, place);
    for (const Vector3d& way : {u, Vector3d(-u), v, Vector3d(-v)})
      if (monotonicNow() < end || loops.empty()) addLoops(trackFrom(subject, place, way, depth), depth, loops);
  }
  std::sort(loops.begin(), loops.end(), [](const Loop& a, const Loop& b) { return a.contrast > b.contrast; });
  return loops;
}

}  // namespace

Verdict longLoopsGiveNoEnergy(const Recipe& recipe, uint64_t) {
  constexpr size_t kMost = 8;                       // loops
  constexpr Nanoseconds kPatience = 1'000'000'000;  // [ns] for the loops after the first one
  const Made made = madeAtRest(recipe);
  if (!made.error.empty()) return made.error;
  Subject& subject = *made.subject;
  if (recipe.touch.places.empty()) return atEachPlace(recipe, [](Subject&, const Place&) { return std::string(); });
  const std::vector<Loop> loops = loopsOf(subject, recipe.touch.places);
  if (loops.empty()) return skipped("its surface goes on smoothly for less than 10 mm");
  const Nanoseconds end = monotonicNow() + kPatience;
  for (size_t i = 0; i < std::min(kMost, loops.size()) && (i == 0 || monotonicNow() < end); ++i)
    if (const auto gift = givenBy(subject, loops[i])) return objectionTo(loops[i], *gift);
  return "";
}

}  // namespace hapticd::conformance
