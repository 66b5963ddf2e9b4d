// SPDX-License-Identifier: MIT
/// Tests a shape that moves: it says so, its contacts belong to the pose that it writes, and it goes with a press.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

constexpr double kLeastWay =
    1e-6;  ///< [m] a shorter motion in one step cannot be distinguished from the error of a search
constexpr double kNoTime = 1e-9;  ///< [s] nothing moves in this time

/// Returns a point of the world in the frame of a pose.
Vector3d inFrame(const hsp_pose& pose, const Vector3d& world) {
  const double* q = pose.orientation;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).conjugate() *
         (world - Vector3d(pose.position[0], pose.position[1], pose.position[2]));
}

/// Returns a point of the frame of a pose in the world.
Vector3d inWorld(const hsp_pose& pose, const Vector3d& point) {
  const double* q = pose.orientation;
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * point +
         Vector3d(pose.position[0], pose.position[1], pose.position[2]);
}

/// Returns how far a pose carries the points of a shape that is 0.1 m large [m].
double wayOf(const hsp_pose& from, const hsp_pose& to) {
  constexpr double kArm = 0.1;
  double farthest = 0;
  for (const Vector3d& point : {Vector3d(0, 0, 0), Vector3d(kArm, 0, 0), Vector3d(0, kArm, 0)})
    farthest = std::max(farthest, (inWorld(to, point) - inWorld(from, point)).norm());
  return farthest;
}

/// How often the contacts of a step were those of the frame before the step, and an example.
struct Lag {
  int judged = 0, late = 0;
  double way = 0, off = 0;   ///< [m] of the worst step: how far the shape moved, how far its contact was off
  int moved = 0;             ///< steps in which the pose changed
  bool tells_speed = false;  ///< one of these steps wrote a velocity
};

/// Returns true if a pose has a velocity other than 0.
bool hasSpeed(const hsp_pose& pose) {
  return Vector3d(pose.linear).squaredNorm() + Vector3d(pose.angular).squaredNorm() > 0;
}

/// Rests the probe in the world while the shape moves. Asks each step again with the probe in the frame of the new
/// pose, and without time to move: both answers must be the same contact.
void follow(Subject& subject, const Vector3d& world, Lag& lag) {
  constexpr int kSteps = 600;
  constexpr double kPart = 0.2;  // of the way: an answer in the wrong frame is off by all of it
  hsp_pose pose{};
  pose.orientation[0] = 1;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d before = inFrame(pose, world);
    const Answer first = subject.step({before}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
    pose = first.pose;
    const Vector3d after = inFrame(pose, world);
    const double way = (after - before).norm();
    if (i == 0 || !(way > kLeastWay) || first.status != HSP_OK) continue;
    ++lag.moved;
    lag.tells_speed |= hasSpeed(pose);
    hsp_probe probe{};
    Eigen::Map<Vector3d>(probe.position) = after;
    probe.orientation[0] = 1;
    const Answer again = subject.stepRaw(probe, kNoTime);
    pose = again.pose;
    const hsp_contact &a = first.contacts[0], &b = again.contacts[0];
    if ((a.flags & b.flags & HSP_OUT_TRACED) == 0 || again.status != HSP_OK) continue;
    const double off = std::max(std::fabs(a.depth_m - b.depth_m), (Vector3d(a.point) - Vector3d(b.point)).norm());
    ++lag.judged;
    if (!(off > kPart * way)) continue;
    ++lag.late;
    if (off > lag.off) lag.way = way, lag.off = off;
  }
}

/// The class must say that its instances may move, because the host reads it before an instance exists.
std::string classSaysSo(const Subject& subject) {
  return (subject.description().flags & HSP_C_MOVES) != 0
             ? ""
             : "activate() reports HSP_R_MOVES, but the class does not say that its instances may move; expected "
               "HSP_C_MOVES in the flags of the class (in C++ the last entry of kInfo)";
}

/// A probe that is held still in the world, and what the shape does about it.
struct Hold {
  double first = 0, deepest = 0;  ///< [m] depth when the probe came, largest depth later
  int after = 0;                  ///< [steps] when it was deepest
};

/// Lets the shape move until it rests while the probe is outside. @return its pose, or nothing if it does not rest
std::optional<hsp_pose> settled(Subject& subject, const Vector3d& outside) {
  constexpr int kMost = 5000, kStill = 200;  // [steps]
  hsp_pose pose{}, then{};
  pose.orientation[0] = 1;
  for (int i = 0, still = 0; i < kMost && still < kStill; ++i) {
    if (still == 0) then = pose;
    pose = subject.step({inFrame(pose, outside)}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0).pose;
    still = wayOf(then, pose) <= kLeastWay ? still + 1 : 0;
    if (still == kStill) return pose;
  }
  return std::nullopt;
}

/// Holds the probe still, that deep below a place of a shape that rests in this pose.
Hold holdStill(Subject& subject, hsp_pose pose, const Place& place, double deep) {
  constexpr int kSteps = 300;
  constexpr double kEnough = 3;  // times the first depth: it comes, and would come ever faster
  const Vector3d world = inWorld(pose, place.foot - place.out * deep);
  Hold hold;
  for (int i = 0; i < kSteps && hold.deepest <= kEnough * hold.first; ++i) {
    const Answer& answer = subject.step({inFrame(pose, world)}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
    pose = answer.pose;
    const hsp_contact& c = answer.contacts[0];
    if (!finite(answer) || (c.flags & HSP_OUT_TRACED) == 0) break;
    if (i == 0) hold.first = hold.deepest = c.depth_m;
    if (c.depth_m > hold.deepest) hold.deepest = c.depth_m, hold.after = i;
  }
  return hold;
}

}  // namespace

Verdict goesWithAPress(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (!made.subject->moves()) return skipped("it does not move by itself");
  if ((made.subject->report().flags & HSP_R_JUMPS) != 0) return skipped("its force jumps on purpose");
  constexpr double kDeep = 5e-4, kOutside = 5e-3;       // [m]
  constexpr double kPart = 1.2, kRoom = 2 * kLeastWay;  // of the first depth, for the error of an integrator; [m]
  int rested = 0;
  Verdict verdict = atEachPlace(recipe, [&](Subject& subject, const Place& place) {
    subject.reset();
    const auto pose = settled(subject, place.foot + place.out * kOutside);
    if (!pose) return std::string();
    ++rested;
    const Hold hold = holdStill(subject, *pose, place, std::min(kDeep, place.through / 2));
    if (hold.deepest <= kPart * hold.first + kRoom) return std::string();
    return "it moves against the hand: a probe was held still " + text(hold.first * 1e3) + " mm deep, below " +
           text(place.foot) + ", and the shape came to it until it was " + text(hold.deepest * 1e3) + " mm deep, " +
           std::to_string(hold.after) +
           " ms later, so a hand would be driven; expected a shape that gives way: what moves it is the opposite of "
           "contact.force, which acts on the probe";
  });
  if (!verdict.clean()) return verdict;
  return rested > 0 ? Verdict("") : skipped("it does not rest while nothing touches it");
}

Verdict restsInNoTime(const Recipe& recipe, uint64_t) {
  const Made made = madeAtRest(recipe);
  if (!made.error.empty()) return made.error;
  hsp_pose start{};
  start.orientation[0] = 1;
  double farthest = 0;  // [m]
  along(*made.subject, [&](const Answer& answer, const Vector3d&) {
    farthest = std::max(farthest, wayOf(start, answer.pose));
    return std::string();
  });
  if (!made.subject->moves())
    return farthest == 0 ? skipped("it does not move by itself")
                         : "step() writes another pose to *step.pose, but activate() does not report that the shape "
                           "moves, so the host ignores the pose: a hand would feel the shape where it is not; expected "
                           "report.flags |= HSP_R_MOVES in activate() (and HSP_C_MOVES in the flags of the class)";
  if (farthest <= kLeastWay) return "";
  return "its pose changes by " + text(farthest) +
         " m in steps that take no time (step.dt_s is 0); expected a motion that follows step.dt_s: the host repeats "
         "no tick, and leaves some out";
}

Verdict contactsOfTheNewPose(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (!made.subject->moves()) return skipped("it does not move by itself");
  if (std::string wrong = classSaysSo(*made.subject); !wrong.empty()) return wrong;
  constexpr double kDeep = 5e-4;  // [m]
  Lag lag;
  Verdict verdict = atEachPlace(recipe, [&](Subject& subject, const Place& place) {
    follow(subject, place.foot - place.out * std::min(kDeep, place.through / 2), lag);
    return std::string();
  });
  if (!verdict.clean()) return verdict;
  if (lag.moved > 0 && !lag.tells_speed)
    return "its pose changes, but pose.linear and pose.angular are always 0; expected its velocities in the world "
           "frame, because probe.velocity is relative to the shape, and a damper would brake the wrong motion";
  if (lag.judged == 0) return skipped("it did not move where it was touched");
  if (2 * lag.late < lag.judged) return "";
  return "it moved by " + text(lag.way) + " m in a step, and its contact was off by " + text(lag.off) +
         " m; expected point and depth in the frame of the pose that step() writes: the probes come in the frame of "
         "the pose before, so move them first";
}

}  // namespace hapticd::conformance
