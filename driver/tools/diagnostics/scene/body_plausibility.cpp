// SPDX-License-Identifier: MIT
/// Judges bodies that move by themselves: where their weight takes them, and whether their masses are plausible.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "diagnostics/scene/given_model.hpp"
#include "diagnostics/scene/value_plausibility.hpp"

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

constexpr double kWeightless = 1e-3;  ///< [m/s^2] a weaker gravity counts as none
constexpr std::string_view kPendulum = "org.hapticd.shape.pendulum";

/// Warns of a body that its weight would move too far, because nothing holds it or its tether is too soft.
void checkContactHold(const GivenModel& given) {
  constexpr double kSizes = 2, kUnknownSize = 0.25;  // sizes of the body by which it may sag; [m] size if it is unknown
  const std::string joint = given.choice("joint");
  Vector3d pull = given.gravity();
  const Vector3d axis = given.vector("axis");
  if (joint == "slider" && axis.norm() > 0) pull = pull.dot(axis) / axis.squaredNorm() * axis;
  const scene::Value* limits = given.find("limits");
  if (joint == "slider" && limits != nullptr && !limits->numbers.empty()) return;  // its end stop holds it
  if (joint == "hinge" || given.number("gravity") == 0 || pull.norm() < kWeightless) return;
  const double weight = given.number("mass") * pull.norm(), tether = given.number("tether");
  if (!(tether > 0))
    return given.warn({"mass", "motion"},
                      given.model().name +
                          " has weight, and nothing holds it: it falls out of reach at once; expected "
                          "tether, a hinge, a slider with limits, or gravity: false");
  const double size = given.box() ? given.size() : kUnknownSize;
  if (const double sag = weight / tether; sag > kSizes * size)
    given.warn({"tether", "mass"},
               fmt::format("a tether of {:g} N/m bears a weight of {:.4g} N, so {} hangs {:.3g} m below its pose; "
                           "expected a stiffer tether, mass in kg, or gravity: false",
                           tether, weight, given.model().name, sag));
}

/// Warns of a centre of mass far outside of the body's surfaces.
void checkCenter(const GivenModel& given) {
  constexpr double kOutside = 0.5;  // share of the size
  const scene::Value* center = given.find("center");
  if (center == nullptr || center->numbers.size() != 3 || !given.box()) return;
  if (const double away = given.box()->exteriorDistance(Vector3d(center->numbers.data()));
      away > kOutside * given.size())
    given.warn({"center"},
               fmt::format("the centre of mass lies {:.3g} m outside the surfaces, which are {:.3g} m large; expected "
                           "a place in m in the model's frame, or [] for the middle of their volume",
                           away, given.size()));
}

/// Warns of an inertia that is too large for the body's mass and size. @param reach [m] farthest place of the body from
/// the axis
void checkInertia(const GivenModel& given, double most, double reach) {
  constexpr double kTimes = 2;
  const double radius = std::sqrt(std::max(most, 0.0) / given.number("mass"));
  if (!given.box() || radius <= kTimes * reach) return;
  given.warn({"inertia"},
             fmt::format("{:g} kg m^2 with {:g} kg means that the mass is {:.3g} m away from the axis, but the body is "
                         "only {:.3g} m large; the value must be in kg m^2 (1 kg mm^2 is 1e-6)",
                         most, given.number("mass"), radius, given.size()));
}

/// Warns of a pivot or an axis that the joint of the body does not use.
void checkJoint(const GivenModel& given) {
  const std::string joint = given.choice("joint");
  const scene::Value *pivot = given.find("pivot"), *axis = given.find("axis");
  if (joint == "free" && (pivot != nullptr || axis != nullptr))
    given.warn({pivot != nullptr ? "pivot" : "axis"},
               fmt::format("has no effect: {} is a free body, because no joint is given; add joint: hinge{} beside it",
                           given.model().name, pivot != nullptr ? "" : " or slider"),
               true);
  if (joint == "slider" && pivot != nullptr && given.vector("pivot").norm() > 0)
    given.warn({"pivot"},
               "has no effect: a slider moves along its axis and does not turn; to make it turn, set joint: hinge",
               true);
}

/// Warns of end stops, or a rest of the spring, in degrees or millimetres.
void checkRange(const GivenModel& given, const char* id) {
  constexpr double kTurn = 2 * M_PI + 1e-3, kSizes = 2, kUnknownSize = 1;  // [rad]; sizes of the body; [m]
  const scene::Value* value = given.find(id);
  const std::string joint = given.choice("joint");
  if (value == nullptr || joint == "free") return;
  const bool turns = joint == "hinge" || given.plugin().id == kPendulum;
  double most = std::abs(value->number);
  for (const double x : value->numbers) most = std::max(most, std::abs(x));
  if (turns && most > kTurn)
    return given.warn({id}, fmt::format("{0:g} rad is more than a whole turn; the value must be in rad: if you meant "
                                        "{0:g} degrees, write {1:.4g}",
                                        most, most * M_PI / 180));
  if (joint == "slider" && most > (given.box() ? kSizes * given.size() : kUnknownSize))
    given.warn({id}, fmt::format("{0:g} m is far for a body that is {1:.3g} m large; "
                                 "the value must be in m: {0:g} mm is {2:g} m",
                                 most, given.size(), most * 1e-3));
}

/// Warns of a drag so strong that no hand moves the body.
void checkDrag(const GivenModel& given) {
  constexpr double kMost = 1000, kCalm = 0.1;      // [N s/m]; [m/s]
  constexpr double kMostTurn = 20, kSlowTurn = 1;  // [N m s/rad]; [rad/s]
  if (const double drag = given.number("drag"); drag > kMost)
    given.warn({"drag"}, fmt::format("with {0:g} N s/m, a force of {2:g} N moves {1} at only {3:g} m/s; the value must "
                                     "be in N s/m (1 N s/mm is 1000 N s/m)",
                                     drag, given.model().name, drag * kCalm, kCalm));
  given.begin();
  if (const double drag = given.number("angular_drag"); drag > kMostTurn)
    given.warn({"angular_drag"},
               fmt::format("with {0:g} N m s/rad, a torque of {2:g} N m turns {1} at only {3:g} rad/s; "
                           "the value must be in N m s/rad (1 mN m s/rad is 0.001)",
                           drag, given.model().name, drag * kSlowTurn, kSlowTurn));
}

/// Warns of a drag so strong that the tether brings the body back only in many seconds.
void checkTetherCreep(const GivenModel& given) {
  constexpr double kLong = 3;  // [s]
  const double tether = given.number("tether"), drag = given.number("drag"), mass = given.number("mass");
  if (!(tether > 0) || drag * drag < 4 * mass * tether || drag < kLong * tether) return;
  given.warn({"drag"},
             fmt::format("with {:g} N s/m and a tether of {:g} N/m, {} takes {:.3g} s to come back by two thirds; "
                         "below {:.2g} N s/m it swings",
                         drag, tether, given.model().name, drag / tether, 2 * std::sqrt(mass * tether)));
}

void checkDynamic(const GivenModel& given) {
  for (const auto& judge : {&checkJoint, &checkContactHold, &checkCenter, &checkDrag, &checkTetherCreep}) {
    given.begin();
    judge(given);
  }
  for (const char* id : {"limits", "rest"}) {
    given.begin();
    checkRange(given, id);
  }
  given.begin();
  const scene::Value* inertia = given.find("inertia");
  if (inertia != nullptr && !inertia->numbers.empty())
    checkInertia(given, *std::max_element(inertia->numbers.begin(), inertia->numbers.end()), given.size());
}

/// Warns of a moment of inertia below mass times length squared, that of a point mass at the centre. Every real body
/// has more (parallel axis theorem).
void checkLeastInertia(const GivenModel& given) {
  constexpr double kRounding = 1e-3;
  const double length = given.number("length"), inertia = given.number("inertia");
  const double least = given.number("mass") * length * length;
  if (inertia > 0 && inertia < (1 - kRounding) * least)
    given.warn({"inertia"},
               fmt::format("{:g} kg m^2 is less than mass times length squared, {:.3g} kg m^2, and no body "
                           "has less about its pivot; "
                           "the value must be the moment about the pivot, not about the centre",
                           inertia, least));
}

double farthestCorner(const Eigen::AlignedBox3d& box, const Vector3d& from) {
  return ((from - box.center()).cwiseAbs() + box.sizes() / 2).norm();
}

/// Returns the direction in which a pendulum hangs: the part of gravity across its axis. If the axis is along gravity,
/// it warns and returns the direction of gravity. It returns nothing if there is no gravity or no axis.
std::optional<Vector3d> hangingOf(const GivenModel& given) {
  constexpr double kAcross = 0.02;  // share of gravity
  const Vector3d gravity = given.gravity(), axis = given.vector("axis").stableNormalized();
  if (gravity.norm() < kWeightless || axis.norm() < 0.5) return std::nullopt;
  const Vector3d across = gravity - gravity.dot(axis) * axis;
  if (across.norm() >= kAcross * gravity.norm()) return across.normalized();
  given.warn({"axis"}, "is along gravity, so no weight turns " + given.model().name +
                           " back; expected an axis across it, such as [0, 0, 1]");
  return gravity.normalized();
}

void checkPendulumInertia(const GivenModel& given) {
  checkLeastInertia(given);
  if (!given.box() || !(given.number("inertia") > 0)) return;
  const double farthest = farthestCorner(*given.box(), given.vector("pivot"));
  checkInertia(given, given.number("inertia"), std::max(given.number("length"), farthest));
}

void checkHanging(const GivenModel& given) {
  constexpr double kOutside = 0.5;  // share of the size
  const auto hanging = hangingOf(given);
  if (!hanging || !given.box()) return;
  const Vector3d center = given.vector("pivot") + given.number("length") * *hanging;
  if (const double away = given.box()->exteriorDistance(center); away > kOutside * given.size())
    given.warn(
        {"pivot", "length"},
        fmt::format("the centre of mass hangs {:.3g} m (length) below the pivot, and this point is {:.3g} m away from "
                    "the model's surfaces; expected a pivot above them (their middle is at [{:.3g}, {:.3g}, {:.3g}])",
                    given.number("length"), away, given.box()->center().x(), given.box()->center().y(),
                    given.box()->center().z()));
}

/// Warns of a damping so strong that a pendulum creeps back to its place only in many seconds.
void checkCreep(const GivenModel& given) {
  constexpr double kLong = 3;  // [s] to come back by two thirds
  const double length = given.number("length"), damping = given.number("damping");
  const double restoring = given.number("mass") * given.gravity().norm() * length;
  const double given_inertia = given.number("inertia");
  const double inertia = given_inertia > 0 ? given_inertia : given.number("mass") * length * length;
  if (!(restoring > 0) || damping * damping < 4 * inertia * restoring || damping < kLong * restoring) return;
  given.warn({"damping"},
             fmt::format("{:g} N m s/rad hold {} so that it creeps: it takes {:.3g} s to come back by two thirds; "
                         "below {:.2g} N m s/rad it swings; the value must be in N m s/rad (1 mN m s/rad is 0.001)",
                         damping, given.model().name, damping / restoring, 2 * std::sqrt(inertia * restoring)));
}

/// Warns of an exponent below 1 that makes contact begin with a jump, because the wall is then steepest at its surface.
void checkFirstTouch(const GivenModel& given) {
  constexpr double kFirst = 1e-5, kJump = 1;  // [m] less than a hand moves in a tick; [N]
  const double scale = given.number("depth_scale"), power = given.number("exponent");
  if (!(power > 0 && power < 1 && scale > 0)) return;
  const double force = given.number("stiffness") * scale * std::pow(kFirst / scale, power);
  if (force > kJump)
    given.warn({"exponent"},
               fmt::format("with a depth_scale of {:g} m the first {:g} um give {:.2g} N, which a hand "
                           "feels as a blow; depth_scale must be in m (1 mm is 0.001), or set exponent: 1",
                           scale, kFirst * 1e6, force));
}

}  // namespace

void checkBody(const GivenModel& given) {
  given.begin();
  checkFirstTouch(given);
  given.begin();
  if (given.choice("motion") == "dynamic" && given.plugin().indexOf("tether") >= 0) checkDynamic(given);
  if (given.plugin().id != kPendulum) return;
  given.begin();
  checkRange(given, "limits");
  for (const auto& judge : {&checkPendulumInertia, &checkHanging, &checkCreep}) {
    given.begin();
    judge(given);
  }
}

}  // namespace hapticd::diagnostics
