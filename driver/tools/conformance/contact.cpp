// SPDX-License-Identifier: MIT
/// Tests a shape where it is touched: its force must push out, its flags must agree with the force, and its claims must
/// be true.
#include <algorithm>
#include <cmath>

#include "conformance/building_blocks.hpp"
#include "servo/safety/claim.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

/// Warns of the thinnest place, if it is so thin that a hand comes through it: with a press of 1 mm, or with a deeper
/// one that needs little force.
Verdict thinnest(const Subject& subject, const Touch& touch) {
  constexpr double kThin = 1e-3, kFewMm = 3e-3, kLight = 3;  // [m], [m], [N]
  const auto place = std::min_element(touch.places.begin(), touch.places.end(),
                                      [](const Place& a, const Place& b) { return a.through < b.through; });
  const double stiffness = subject.report().max_stiffness;
  const bool light = place->through < kFewMm && stiffness * place->through < kLight;
  if (place->through >= kThin && !light) return "";
  const std::string with =
      stiffness > 0 ? " (" + roughly(stiffness * place->through) + " N at the claimed stiffness)" : "";
  return warned(placed("the shape is thin here: from a depth of about " + roughly(place->through * 1e3) + " mm on" +
                           with +
                           " it names the surface on the other side and pushes the hand out there; expected either a "
                           "thicker shape, or one that keeps each probe on the side from which it came until it comes "
                           "out; the other tests press only " +
                           roughly(pressDepth(subject, *place) * 1e3) + " mm deep here",
                       place->foot));
}

/// Warns of a surface that is so far away from the origin of its own frame that a hand at the model does not reach it.
Verdict farAway(const Touch& touch) {
  constexpr double kFar = 1;  // [m] farther than the arms reach
  const auto place = std::min_element(touch.places.begin(), touch.places.end(),
                                      [](const Place& a, const Place& b) { return a.foot.norm() < b.foot.norm(); });
  const double away = place->foot.norm();
  if (away <= kFar) return "";
  return warned(placed("the nearest surface is " + roughly(away) +
                           " m away from the origin of the model's frame, where no hand at the model reaches it; "
                           "expected a surface near the origin (the pose in the scene places it), and lengths in m: " +
                           roughly(away) + " mm is " + roughly(away * 1e-3) + " m",
                       place->foot));
}

/// Fails if no contact was found, because without a contact no test of contacts would test anything.
Verdict contactFound(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const Touch touch = recipe.touch.places.empty() ? findTouch(recipe) : recipe.touch;
  if (!touch.places.empty()) {
    const Verdict far = farAway(touch);
    return far.text.empty() ? thinnest(*made.subject, touch) : far;
  }
  if (touch.traced)
    return "NOT TESTED: its depth is nowhere above 0, not even 1 mm behind the foot points that it names; expected "
           "depth_m above 0 inside: look at the sign of depth_m and at point";
  if (touch.felt) return fieldOnly();
  return "NOT TESTED: it answered neither a foot point (HSP_OUT_TRACED) nor a force, on any side of the origin "
         "from 1 mm to 1 m; expected a contact to test: trace the surface while the probe is outside too, tell "
         "where the shape is by hsp.geometry/1 (bounds), or give parameters with --set that bring it to the origin";
}

/// Returns why forces pull the hand in. The whole press is judged, because a detent may pull for part of it. The
/// direction outward comes from the foot points, not from the normal, which may have the wrong sign as well.
std::string wrongSign(Subject& subject, const Place& place) {
  double outward = 0, most = 0, depth = 0, normal = 0;
  press(subject, place, [&](const Answer& answer, const PressStep&) {
    const hsp_contact& c = answer.contacts[0];
    if ((c.flags & HSP_OUT_TRACED) == 0 || !(c.depth_m > 0)) return std::string();
    const double force = Vector3d(c.force).dot(place.out);
    outward += force;
    normal += Vector3d(c.normal).dot(place.out);
    if (force < most) most = force, depth = c.depth_m;
    return std::string();
  });
  if (outward >= 0) return "";
  const Vector3d& f = place.foot;
  return "the sign is wrong: pressed at " + text(f.x()) + ", " + text(f.y()) + ", " + text(f.z()) +
         " m, the forces pull the hand in, with " + text(-most) + " N at a depth of " + text(depth * 1e3) +
         " mm; expected a force that points out of the shape" +
         (normal < 0 ? ": its normal points into the shape as well; where depth_m is above 0 outside, turn depth_m, "
                       "else turn the sign of normal first"
                     : ", as its normal does: turn the sign of force");
}

/// Finds pulls for which a run would silence the model, on the straight path in from some mm outside and during a
/// press.
std::string pullsThere(Subject& subject, const Place& place) {
  constexpr double kFar = 5e-3;  // [m] the force of a magnet would be felt at this distance
  constexpr int kSteps = 100;
  const auto objection = [](const hsp_contact& c, const Vector3d& p) {
    if (!servo::pullsIn(c, p)) return std::string();
    const double away = (p - Vector3d(c.point)).norm() * 1e3;
    return placed("it reports to push only (HSP_R_PUSHES), and pulls with " + text(Vector3d(c.force).norm()) + " N, " +
                      text(away) + " mm " + (c.depth_m > 0 ? "below" : "outside of") +
                      " the surface: a run silences it at the first such answer; expected a force that points out of "
                      "the shape, or, where it pulls on purpose, as a magnet does, no HSP_R_PUSHES in activate()",
                  p);
  };
  for (int i = 0; i <= kSteps; ++i) {
    const Vector3d p = place.foot + place.out * (kFar * (kSteps - i) / kSteps);
    const Answer& answer = subject.step({p}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
    if (std::string pulls = objection(answer.contacts[0], p); !pulls.empty()) return pulls;
  }
  std::string pulls;
  press(subject, place,
        [&](const Answer& answer, const PressStep& step) { return pulls = objection(answer.contacts[0], step.p); });
  return pulls;
}

Verdict forceOutward(const Recipe& recipe, uint64_t) {
  return atEachPlace(recipe, [](Subject& subject, const Place& place) {
    std::string wrong = wrongSign(subject, place);
    // pulls are judged only for shapes that claim to push and stand still
    const bool pushes = (subject.report().flags & HSP_R_PUSHES) != 0 && !subject.moves();
    return wrong.empty() && pushes ? pullsThere(subject, place) : wrong;
  });
}

/// Returns how an answer disagrees with its flags, or "".
std::string flagsOf(const hsp_contact& c) {
  const bool traced = (c.flags & HSP_OUT_TRACED) != 0, contact = (c.flags & HSP_OUT_CONTACT) != 0;
  const bool named = Vector3d(c.normal).norm() > 0 || std::abs(c.depth_m) > 0;
  if (!traced && named) return "a normal or a depth is given without HSP_OUT_TRACED, so that the host does not read it";
  if (traced && c.depth_m > 0 && !contact)
    return "depth_m is above 0 without HSP_OUT_CONTACT: set both flags in contact";
  if (traced && !(c.depth_m > 0) && contact)
    return "HSP_OUT_CONTACT is set at a depth of " + text(c.depth_m) +
           " m: set it above 0 alone; a force from outside, as of a magnet or of glue, needs no flag";
  return "";
}

Verdict contactFlags(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  return along(*made.subject, [](const Answer& answer, const Vector3d&) { return flagsOf(answer.contacts[0]); });
}

/// [N/m] Returns the slopes of the force in a straight press at rest, sorted by size. A claimed jump (max_jump) is no
/// slope, so it is subtracted. The slopes are then taken over longer distances, so that the subtraction hides little.
std::vector<double> slopesOf(Subject& subject, const Place& place) {
  const hsp_report& report = subject.report();
  const double jump = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  const size_t apart = jump > 0 ? 25 : 1;
  std::vector<double> slopes, forces, at;
  press(subject, place, [&](const Answer& answer, const PressStep& step) {
    if (!step.settled) return std::string();
    const hsp_contact& c = answer.contacts[0];
    if (!(c.depth_m > 0)) {
      forces.clear(), at.clear();
      return std::string();
    }
    forces.push_back(Vector3d(c.force).dot(place.out)), at.push_back(step.p.dot(place.out));
    if (forces.size() <= apart) return std::string();
    const size_t before = forces.size() - 1 - apart;
    const double change = forces.back() - forces[before];
    const double slope = std::copysign(std::max(0.0, std::abs(change) - jump), change) / (at[before] - at.back());
    slopes.push_back(slope);
    return std::string();
  });
  std::sort(slopes.begin(), slopes.end());
  return slopes;
}

/// [N/m] Returns the slopes of the force in a press that waits at each place until effects of the motion have faded,
/// because the force of a velocity filter is not stiffness.
std::vector<double> slopesAtRest(Subject& subject, const Place& place) {
  constexpr int kPlaces = 10, kRest = 200;  // ticks to wait at each place
  const double depth = pressDepth(subject, place);
  const hsp_report& report = subject.report();
  const double jump = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  std::vector<double> slopes;
  double before = 0;
  for (int i = 0; i <= kPlaces; ++i) {
    const Vector3d p = place.foot - place.out * depth * i / kPlaces;
    subject.step({p}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
    for (int k = 0; k < kRest; ++k) subject.step({p}, kConformanceDt);
    const double force = Vector3d(subject.step({p}, kConformanceDt).contacts[0].force).dot(place.out);
    if (i > 0) slopes.push_back(std::max(0.0, force - before - jump) * kPlaces / depth);
    before = force;
  }
  std::sort(slopes.begin(), slopes.end());
  return slopes;
}

/// [N/m] Returns the slope that nine tenths of the slopes in a press do not exceed; 0 if there are too few slopes.
double stiffnessAt(Subject& subject, const Place& place, double claimed) {
  constexpr double kDoubtful = 1.1;
  const std::vector<double> slopes = slopesOf(subject, place);
  if (slopes.size() < 10) return 0;
  const double measured = slopes[slopes.size() * 9 / 10];
  if (measured <= kDoubtful * claimed) return measured;
  const std::vector<double> rested = slopesAtRest(subject, place);
  return std::min(measured, rested[rested.size() * 9 / 10]);
}

/// Returns a text that compares the measured stiffness with the claimed one.
std::string besideClaim(double claimed, double measured) {
  return (claimed > 0 ? "it claims " + text(claimed) + " N/m" : std::string("it claims no stiffness")) +
         ", but its force grows by " + text(measured) +
         " N/m; set report.max_stiffness in activate() to at least this value; if the force is meant to vibrate or "
         "snap, call hapticd::reportJumps(report, NEWTONS) in activate() instead";
}

double middleOf(std::vector<double> sorted) {
  std::sort(sorted.begin(), sorted.end());
  return sorted.empty() ? 0 : sorted[sorted.size() / 2];
}

/// Returns why the stiffness that contacts report is wrong, or "". It is wrong if it has the wrong sign or is far too
/// small for a check of stability. A stiffness of 0 means unknown, and one that is too large is on the safe side.
std::string toldStiffness(Subject& subject, const Place& place) {
  constexpr double kFar = 3, kNoise = 10;  // factor, because a force law may be steeper in places; [N/m]
  std::vector<double> told;
  press(subject, place, [&told](const Answer& answer, const PressStep& step) {
    const hsp_contact& c = answer.contacts[0];
    if (step.settled && c.depth_m > 0 && c.stiffness != 0) told.push_back(c.stiffness);
    return std::string();
  });
  const std::vector<double> slopes = slopesOf(subject, place);
  if (told.size() < 10 || slopes.size() < 10) return "";
  const double says = middleOf(told), is = middleOf(slopes);
  // such a shape may report the stiffness of its nearest part
  const bool soft = (subject.description().flags & HSP_C_DEFORMS) != 0;
  if (soft ? says >= 0 : kFar * says + kNoise >= is) return "";
  return placed("contact.stiffness is " + text(says) + " N/m, but the force grows by " + text(is) +
                    " N/m there; expected the local slope of the force over the depth, or 0 if it is unknown",
                place.foot);
}

Verdict stiffnessClaim(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const double claimed = made.subject->report().max_stiffness;
  // factors by which the claim may be exceeded, because a force law may be a little steeper in places; [N/m]
  constexpr double kFails = 1.5, kWarns = 1.1, kNoise = 10;
  double steepest = 0;
  Verdict verdict = atEachPlace(
      recipe,
      [claimed, &steepest](Subject& subject, const Place& place) {
        const double measured = stiffnessAt(subject, place, claimed);
        steepest = std::max(steepest, measured);
        return measured <= kFails * claimed + kNoise ? toldStiffness(subject, place) : besideClaim(claimed, measured);
      },
      Time::kStands);
  if (!verdict.clean() || steepest == 0) return verdict;
  if (steepest > kWarns * claimed + kNoise) return warned(besideClaim(claimed, steepest));
  return noted("it claims " + text(claimed) + " N/m, and its force grows by " + text(steepest) + " N/m at most");
}

/// Returns by how much a torque jumps where the surface is met, or "".
std::string torqueAtOnce(const Vector3d& before, const Vector3d& now, double explained) {
  // [N m] not felt as a step; [m] lever arm with which a force may turn the tip
  constexpr double kRoom = 0.01, kLever = 0.1;
  const double jump = (now - before).norm();
  if (jump <= kRoom + kLever * explained) return "";
  return "the torque jumps by " + text(jump) +
         " N m where the surface is met; "
         "expected it to grow from 0 with the depth, and about the probe, not about the model's origin";
}

/// Tests that the force does not jump where the surface is met, because a jump buzzes even if the slope below the
/// surface is small.
Verdict noStep(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const hsp_report& report = made.subject->report();
  const double stiffness = report.max_stiffness > 0 ? report.max_stiffness : servo::Claim::kUnclaimed;
  const double jumps = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  return atEachPlace(
      recipe,
      [stiffness, jumps](Subject& subject, const Place& place) {
        constexpr double kRoom = 0.1;  // [N] not felt as a step
        bool known = false, inside = false;
        Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero(), at = Vector3d::Zero();
        return press(subject, place, [&](const Answer& answer, const PressStep& step) {
          if (!step.settled) return std::string();
          const hsp_contact& c = answer.contacts[0];
          const bool entered = known && !inside && c.depth_m > 0;
          const double jump = (Vector3d(c.force) - force).norm(), way = (step.p - at).norm();
          const double explained = servo::Claim::kMargin * stiffness * way + jumps;
          std::string turned = entered ? torqueAtOnce(torque, Vector3d(c.torque), explained) : std::string();
          known = true, inside = c.depth_m > 0, force = Vector3d(c.force), torque = Vector3d(c.torque), at = step.p;
          if (!turned.empty()) return turned;
          if (!entered || jump <= explained + kRoom) return std::string();
          return "the force jumps by " + text(jump) + " N within " + text(way * 1e6) +
                 " um where the surface is met; expected it to grow from 0 with the depth (a jump on purpose is "
                 "claimed: HSP_R_JUMPS and max_jump)";
        });
      },
      Time::kStands);
}

/// The depths and forces of a press far below the surface that rests at each depth. It ends where the foot point leaves
/// the surface.
struct DeepPress {
  std::vector<double> depth, force;  ///< [m], [N] outward
};

DeepPress pressDeep(Subject& subject, const Place& place) {
  constexpr double kStep = 1e-4, kStrongest = 10;  // [m]; [N] more than most hands press
  const double most = deepestPress(subject, place);
  // [ticks] in this time the force of a damper fades completely, and that of a velocity filter nearly
  constexpr int kRest = 10;
  DeepPress press;
  for (int i = 0; i * kStep <= most; ++i) {
    const Vector3d p = place.foot - place.out * (i * kStep);
    subject.step({p}, kConformanceDt, i == 0 ? uint32_t{HSP_IN_JUMP} : 0);
    for (int k = 0; k < kRest; ++k) subject.step({p}, kConformanceDt);
    const hsp_contact& c = subject.step({p}, kConformanceDt).contacts[0];
    const bool same = (c.flags & HSP_OUT_TRACED) != 0 && Vector3d(c.normal).dot(place.out) > 0.9;
    if (i > 0 && (!same || !(c.depth_m > press.depth.back()) || press.force.back() > kStrongest)) break;
    press.depth.push_back(c.depth_m), press.force.push_back(Vector3d(c.force).dot(place.out));
  }
  return press;
}

/// Tests depths that other tests do not reach, where the force may become steep or click.
Verdict deepPress(const Recipe& recipe, uint64_t) {
  constexpr double kRoom = 0.1;  // [N] not felt as a step
  constexpr size_t kApart = 10;  // steps over which a slope is taken
  // factors by which the claim may be exceeded: over kApart steps, as at the surface; from one step to the next
  constexpr double kSteep = 1.5, kJump = 3;
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const hsp_report& report = made.subject->report();
  if ((made.subject->description().flags & HSP_C_DEFORMS) != 0)
    return skipped("it deforms, so its force does not depend on the depth alone");
  const double claimed = report.max_stiffness, jumps = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  if (!(claimed > 0)) return skipped("no stiffness is claimed");
  Verdict steep = "";
  int left = 4;  // [places] at all of them, a slow shape would take too long
  Verdict verdict = atEachPlace(
      recipe,
      [&](Subject& subject, const Place& place) {
        if (left-- <= 0) return std::string();
        const DeepPress press = pressDeep(subject, place);
        for (size_t i = 1; i < press.force.size(); ++i) {
          const double way = press.depth[i] - press.depth[i - 1], jump = std::abs(press.force[i] - press.force[i - 1]);
          if (jump > kJump * claimed * way + kRoom + jumps)
            return "the force jumps by " + text(jump) + " N within " + text(way * 1e6) + " um at a depth of " +
                   text(press.depth[i] * 1e3) + " mm, below " + text(place.foot) + "; expected what " + text(claimed) +
                   " N/m explain (a jump on purpose is claimed: HSP_R_JUMPS and max_jump)";
          if (i < kApart || !steep.clean()) continue;
          const double slope =
              (press.force[i] - press.force[i - kApart] - jumps) / (press.depth[i] - press.depth[i - kApart]);
          if (slope > kSteep * claimed + kRoom / (kApart * way))
            steep = warned("at a depth of " + text(press.depth[i] * 1e3) + " mm " + besideClaim(claimed, slope));
        }
        return std::string();
      },
      Time::kStands);
  return verdict.clean() ? steep : verdict;
}

}  // namespace

std::vector<ConformanceTest> contactTests() {
  return {
      {"contact-found", "the shape can be found and touched", &contactFound, kFinite},
      {"force-outward", "forces in contact push out of the shape", &forceOutward, kRests},
      {kFoot, "the foot point is on the surface, as far away as the depth says, and the normal points to the probe",
       &footAndNormal, "depth-falls-outward"},
      {"force-along-normal", "a shape that only pushes, and has no friction, pushes along its normal",
       &forceAlongNormal, kFoot},
      {"torque-about-probe", "the torque is about the probe, not about the model's origin", &torqueAboutProbe, kFinite},
      {"loops-give-no-energy", "a loop into the shape, along below its surface and out again gives no energy",
       &loopsGiveNoEnergy, kRests},
      {"damping-sign", "a damper brakes the hand: moving in it pushes no less than moving out", &dampingSign, kRests},
      {"long-loops-give-no-energy", "nor does one of 10 or 20 mm, between places of different stiffness",
       &longLoopsGiveNoEnergy, "loops-give-no-energy"},
      {"contacts-of-new-pose", "the contacts of a shape that moves belong to the pose that it writes",
       &contactsOfTheNewPose, kRests},
      {"goes-with-a-press", "a shape that gives way moves with the press, not against it", &goesWithAPress,
       "force-outward"},
      {"contact-flags", "HSP_OUT_TRACED and HSP_OUT_CONTACT agree with depth and normal", &contactFlags, kFinite},
      {"force-from-zero", "the force grows from zero where the surface is met", &noStep, kRests},
      {"stiffness-vs-claim", "forces are no steeper than claimed", &stiffnessClaim, kRests},
      {"deep-press", "deep below the surface the force still follows the claim", &deepPress, kRests},
      {"drawing-where-felt", "triangles and bounds of hsp.geometry/1 are where the surface is felt", &drawingWhereFelt,
       kRests},
      {"bounds-where-felt", "the bounds of hsp.geometry/1 hold the surface that is felt", &boundsWhereFelt, kFinite},
  };
}

}  // namespace hapticd::conformance
