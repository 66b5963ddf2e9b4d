// SPDX-License-Identifier: MIT
/// Tests whether point, normal and depth of an answer belong to one surface, as the ABI requires. The host uses them to
/// predict contacts, to judge pulls and edges, and to draw.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

constexpr double kOffPart = 0.01;  ///< tolerance as a share of the length, because a foot that is followed is not exact
constexpr double kOffLeast = 1e-6;  ///< [m] least tolerance of a length
constexpr double kOffAngle = 0.02;  ///< [rad] tolerance of a direction, a little more than a degree

/// What the answer to a resting probe says about the surface.
struct Foot {
  bool known = false;
  Vector3d p = Vector3d::Zero(), point = Vector3d::Zero(), normal = Vector3d::Zero();
  double depth = 0, residual = 0;
  bool edge = false;

  double away() const { return (p - point).norm(); }
  /// [m] Returns the tolerance of lengths.
  double room() const { return kOffLeast + kOffPart * away() + std::abs(residual); }
};

Foot footFor(Subject& subject, const Vector3d& p) {
  const hsp_contact c = answerAtRest(subject, p);
  Foot foot;
  foot.known = (c.flags & HSP_OUT_TRACED) != 0;
  foot.p = p, foot.point = Vector3d(c.point), foot.normal = Vector3d(c.normal);
  foot.depth = c.depth_m, foot.residual = c.residual_m;
  foot.edge = (c.flags & HSP_OUT_EDGE) != 0;
  return foot;
}

/// Returns why the foot is not on the surface, or "". A probe at the foot must have a depth of 0. Outside, the foot
/// must be as far away as the depth says; inside, a shape may measure its depth in another way.
std::string offTheSurface(Subject& subject, const Foot& foot) {
  const Foot there = footFor(subject, foot.point);
  if (there.known && std::abs(there.depth) > foot.room() + std::abs(there.residual))
    return placed("point is not on the surface: a probe at the point that is named, " + text(foot.point) +
                      ", is told a depth of " + text(there.depth) + " m; expected the nearest point of the surface",
                  foot.p);
  if (foot.depth < 0 && std::abs(foot.away() + foot.depth) > foot.room())
    return placed("point is " + text(foot.away()) + " m away and depth_m says " + text(foot.depth) +
                      " m; outside, depth_m is minus the distance to point, which is the nearest point of the surface",
                  foot.p);
  return "";
}

/// Returns true if the normal cannot be judged. If the foot stays in place while the probe moves sideways, it lies on
/// an edge, where many normals are right. If the foot leaps, another part of the surface is nearer.
bool staysOrLeaps(const Foot& before, const Foot& after) {
  constexpr double kStays = 0.2, kLeaps = 5;  // share of the distance that the probe moved
  const double foot = (after.point - before.point).norm(), probe = (after.p - before.p).norm();
  return foot < kStays * probe || foot > kLeaps * probe;
}

/// Returns what is wrong with the normal, or "". Outside, it must point from the foot to the probe, inside from the
/// probe to the foot. Depth must not change across the normal.
std::string wrongNormal(Subject& subject, const Foot& foot, double aside) {
  if (foot.edge || foot.away() < 10 * kOffLeast) return "";
  const Vector3d u = foot.normal.unitOrthogonal(), v = foot.normal.cross(u);
  double steepest = 0;
  for (const Vector3d& side : {u, v}) {
    const Foot one = footFor(subject, foot.p - aside * side), other = footFor(subject, foot.p + aside * side);
    if (!one.known || !other.known || one.edge || other.edge || staysOrLeaps(one, other)) return "";
    steepest = std::max(steepest, std::abs(other.depth - one.depth) / (2 * aside));
  }
  const double angle = std::asin(std::min(1.0, foot.normal.cross((foot.p - foot.point).normalized()).norm()));
  if (angle > kOffAngle + foot.residual / foot.away())
    return placed("the normal lies " + text(angle * 180 / M_PI) + " degrees off the line from point to the probe; " +
                      "expected the outward unit normal of the surface at point, the nearest one (on an edge, " +
                      "HSP_OUT_EDGE)",
                  foot.p);
  if (steepest > 2.5 * kOffAngle + foot.residual / aside)
    return placed("depth_m changes by " + text(steepest) +
                      " m where the probe goes 1 m across the normal; expected 0: it changes along the normal alone",
                  foot.p);
  return "";
}

std::string wrongFoot(Subject& subject, const Place& place) {
  const double reach = pressDepth(subject, place);
  for (const double part : {1.0, 0.3, -0.3}) {
    const Foot foot = footFor(subject, place.foot + part * reach * place.out);
    if (!foot.known) continue;
    std::string wrong = offTheSurface(subject, foot);
    if (wrong.empty()) wrong = wrongNormal(subject, foot, 0.03 * reach);
    if (!wrong.empty()) return wrong;
  }
  return "";
}

}  // namespace

Verdict footAndNormal(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if ((made.subject->description().flags & HSP_C_DEFORMS) != 0)
    return skipped("it deforms, so its foot point moves too");
  return atEachPlace(recipe, &wrongFoot, Time::kStands);
}

namespace {

/// Returns how the force of a press deviates from its normal, or "". @param at_rest true to judge the steps at rest,
/// false to judge those in motion, where friction acts
std::string offTheNormal(Subject& subject, const Place& place, bool at_rest) {
  return press(subject, place, [at_rest](const Answer& answer, const PressStep& step) {
    constexpr double kLeast = 0.02;  // [N] above which a force has a direction
    const hsp_contact& c = answer.contacts[0];
    const Vector3d force(c.force), normal(c.normal);
    if (step.settled != at_rest || (c.flags & HSP_OUT_EDGE) != 0 || force.norm() < kLeast) return std::string();
    const double angle = std::atan2(force.cross(normal).norm(), std::abs(force.dot(normal)));
    if (angle <= kOffAngle) return std::string();
    return "it reports to push only and to have no friction (HSP_R_PUSHES), and its force of " + text(force.norm()) +
           " N on a probe " + (at_rest ? "at rest" : "that moves") + " lies " + text(angle * 180 / M_PI) +
           " degrees off its normal; expected " +
           (at_rest ? "force = normal times a size, or, for friction, no HSP_R_PUSHES in activate()"
                    : "no HSP_R_PUSHES in activate() of a shape that has friction, "
                      "viscosity or damping along the surface");
  });
}

}  // namespace

Verdict forceAlongNormal(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if ((made.subject->report().flags & HSP_R_PUSHES) == 0)
    return skipped("it does not report to push only and without friction (HSP_R_PUSHES)");
  return atEachPlace(recipe, [](Subject& subject, const Place& place) {
    std::string wrong = offTheNormal(subject, place, true);
    return wrong.empty() ? offTheNormal(subject, place, false) : wrong;
  });
}

Verdict torqueAboutProbe(const Recipe& recipe, uint64_t) {
  constexpr double kLeast = 1e-4, kClose = 0.01;  // [N m] least torque that is judged; share of it
  constexpr int kEnough = 20;                     // steps at one place
  return atEachPlace(recipe, [](Subject& subject, const Place& place) {
    int judged = 0, same = 0;
    Vector3d torque = Vector3d::Zero(), p = Vector3d::Zero();
    press(subject, place, [&](const Answer& answer, const PressStep& step) {
      const hsp_contact& c = answer.contacts[0];
      const Vector3d about_origin = step.p.cross(Vector3d(c.force)), told(c.torque);
      if (!(c.depth_m > 0) || about_origin.norm() < kLeast || told.norm() < kLeast) return std::string();
      ++judged;
      if ((told - about_origin).norm() > kClose * about_origin.norm()) return std::string();
      ++same, torque = told, p = step.p;
      return std::string();
    });
    if (same < kEnough || same < judged) return std::string();
    return placed("contact.torque of " + text(torque.norm()) +
                      " N m is the torque of the force about the model's origin; expected the torque on the probe, "
                      "about the probe: zero where the force acts at its tip",
                  p);
  });
}

}  // namespace hapticd::conformance
