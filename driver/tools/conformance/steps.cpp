// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>

#include "conformance/building_blocks.hpp"
#include "servo/safety/claim.hpp"
#include "servo/safety/guard.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

Verdict finiteOutputs(const Recipe& recipe, uint64_t seed) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  int number = 0;
  const auto look = [&number](const Answer& answer, const Vector3d&) {
    ++number;
    const std::string wrong = wrongStatus(answer);
    return wrong.empty() ? "" : "in step " + std::to_string(number) + " " + wrong;
  };
  if (std::string wrong = along(*made.subject, look); !wrong.empty()) return wrong;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> step(0, 1e-3);
  Vector3d p = onPath(*made.subject, 0.3);
  for (int i = 0; i < kConformanceSteps; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    if (std::string wrong = wrongStatus(made.subject->step({p}, kConformanceDt)); !wrong.empty())
      return "in step " + std::to_string(i + 1) + " of a random walk, " + placed(wrong, p);
  }
  return "";
}

/// Gives the shape bad samples (HSP_IN_INVALID) during a contact, where a shape that ignores the flag would go on
/// pushing.
Verdict badSample(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  return along(*made.subject, [&](const Answer& good, const Vector3d& p) -> std::string {
    if (Vector3d(good.contacts[0].force).isZero(0) && made.subject->places().size() > 0) return "";
    hsp_probe bad{};
    Eigen::Map<Vector3d>(bad.position) = p;
    bad.orientation[0] = 1;
    bad.flags = HSP_IN_INVALID;
    const Answer& answer = made.subject->stepRaw(bad, kConformanceDt);
    const std::string wrong = wrongStatus(answer);
    const double force = Vector3d(answer.contacts[0].force).norm();
    if (!wrong.empty()) return "with a probe that has no good sample (HSP_IN_INVALID) " + wrong;
    if (!(force > 0)) return "";
    return "a force of " + text(force) +
           " N was the answer to a probe that has no good sample (HSP_IN_INVALID; its position is the last good one); "
           "expected no force: if ((probe.flags & HSP_IN_INVALID) != 0) return HSP_OK";
  });
}

std::string jumped(double newtons, double metres, double stiffness) {
  return "the force jumped by " + text(newtons) + " N while the probe moved " + text(metres) +
         " m: the claimed stiffness (report.max_stiffness, " + text(stiffness) + " N/m) explains " +
         text(stiffness * metres) +
         " N of it, and it is the third such jump; "
         "look for a length that is not in m, a gap in the law of the force, or a claim that is too small";
}

Verdict forceContinuous(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (!(made.subject->report().max_stiffness > 0)) return skipped("no stiffness is claimed");
  const hsp_report& report = made.subject->report();
  servo::ClaimBounds bounds;
  bounds.stiffness = report.max_stiffness;
  bounds.damping = made.subject->damping();
  bounds.jump = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  servo::Claim claim;
  int jumps = 0;
  Vector3d last = Vector3d::Zero(), force = Vector3d::Zero();
  return along(*made.subject, [&](const Answer& answer, const Vector3d& p) {
    const hsp_contact& contact = answer.contacts[0];
    servo::ClaimStep step;
    step.force = Vector3d(contact.force);
    step.normal = Vector3d(contact.normal);
    step.p_world = step.p_model = p;
    const double way = (p - last).norm(), jump = (step.force - force).norm();
    step.velocity = (p - last) / kConformanceDt;
    step.out = contact.flags;
    step.in = answer.jumped ? HSP_IN_JUMP : 0;
    if (answer.jumped) step.velocity.setZero();
    step.former = true;  // the answer before is compared too; no search runs here, so after a jump a shape must find
                         // its surface at once
    last = p, force = step.force;
    bool held = false;
    claim.check(step, bounds, kConformanceDt, held);
    jumps += held ? 1 : 0;
    return jumps >= 3 ? jumped(jump, way, bounds.stiffness) : std::string();
  });
}

Verdict normalUnit(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  return along(*made.subject, [](const Answer& answer, const Vector3d&) {
    const hsp_contact& c = answer.contacts[0];
    const double norm = Vector3d(c.normal).norm();
    const bool traced = (c.flags & HSP_OUT_TRACED) != 0;
    return traced && std::abs(norm - 1) > 1e-6 ? "expected a normal of length 1, but its length is " + text(norm)
                                               : std::string();
  });
}

double medianOf(std::vector<double> values) {
  if (values.empty()) return 1;
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Checks that depths and foot points are in m. The depth must change by as much as the probe moves along the normal.
/// Outside, the foot point must be as far away as the depth says.
class LengthsInMetres {
 public:
  void add(const hsp_contact& c, const Vector3d& p, const Vector3d& before, double depth_before) {
    constexpr double kOutside = 1e-4;  // [m] a probe farther from its foot than this is outside
    if (const double away = (p - Vector3d(c.point)).norm(); !(c.depth_m > 0) && away > kOutside) {
      ++outside_;
      if (c.depth_m == 0) ++flat_;
    }
    constexpr double kLeast = 1e-7, kFar = 1e-5;  // [m] least step and least depth that are judged
    const double out = Vector3d(c.normal).dot(p - before);
    if (std::abs(out) > std::max(kLeast, 0.5 * (p - before).norm())) rates_.push_back((depth_before - c.depth_m) / out);
    if (std::abs(c.depth_m) > kFar) feet_.push_back((p - Vector3d(c.point)).norm() / std::abs(c.depth_m));
  }
  std::string wrong() const {
    constexpr double kFar = 3;  // factor, because a shape may measure its depth in another way, but in m
    if (2 * flat_ > outside_)
      return "depth_m is 0 outside of the shape, where HSP_OUT_TRACED is set; "
             "expected minus the distance to the surface";
    const double rate = std::abs(medianOf(rates_)), foot = medianOf(feet_);
    if (rate > kFar || rate < 1 / kFar)
      return "depth_m changes by " + text(rate) +
             " m where the probe moves by 1 m along the normal; expected 1: look for a depth that is not in m";
    if (foot > kFar || foot < 1 / kFar)
      return "point is " + text(foot) +
             " times as far from the probe as depth_m says; "
             "expected the foot on the surface, in m, in the model's frame";
    return "";
  }

 private:
  std::vector<double> rates_, feet_;
  size_t outside_ = 0, flat_ = 0;  ///< number of steps outside, and how many of these report a depth of 0
};

/// Fails unless depth falls when the probe moves along the normal; otherwise depth or normal has the wrong sign, and so
/// has the force.
Verdict depthOutward(const Recipe& recipe, uint64_t) {
  const Made made = madeAtRest(recipe);
  if (!made.error.empty()) return made.error;
  double agrees = 0, depth = 0;
  Vector3d last = Vector3d::Zero();
  bool known = false;
  LengthsInMetres lengths;
  along(*made.subject, [&](const Answer& answer, const Vector3d& p) {
    const hsp_contact& c = answer.contacts[0];
    const bool traced = (c.flags & HSP_OUT_TRACED) != 0;
    known = known && !answer.jumped;
    const double out = Vector3d(c.normal).dot(p - last), way = (p - last).norm();
    if (traced && known) agrees -= out * std::clamp(c.depth_m - depth, -way, way);
    if (traced && known) lengths.add(c, p, last, depth);
    known = traced;
    depth = c.depth_m;
    last = p;
    return std::string();
  });
  if (agrees < 0) return "depth grows toward the outward normal: depth or normal has the wrong sign";
  // a surface that gives way is not judged
  return (made.subject->description().flags & HSP_C_DEFORMS) != 0 ? "" : lengths.wrong();
}

Verdict energyNonIncreasing(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const double before = made.subject->energy();
  if (made.subject->moves() && std::isnan(before)) return skipped("it moves and does not report its stored energy");
  double given = 0, moved = 0;
  Vector3d last = onPath(*made.subject, 0), force = Vector3d::Zero();
  constexpr int kSlow = 20000;
  along(
      *made.subject,
      [&](const Answer& answer, const Vector3d& p) {
        const Vector3d now(answer.contacts[0].force);
        if (answer.jumped) last = p;
        given += 0.5 * (force + now).dot(p - last);
        moved += std::abs(0.5 * (force + now).dot(p - last));
        last = p;
        force = now;
        return "";
      },
      kSlow);
  if (made.subject->moves()) return "";  // gravity also works on a moving shape; another test bounds its stored energy
  const double gained = std::isnan(before) ? 0 : made.subject->energy() - before;
  constexpr double kRounding = 0.02;  // share of the work in both directions, because the path is made of steps
  const double allowed = kRounding * moved + 1e-6 - gained;
  return given <= allowed ? ""
                          : "a closed path gave " + text(given) + " J to the hand, of " + text(moved) +
                                " J exchanged, so a hand that repeats it would be driven; expected "
                                "none: a force on the way out that is no greater than on the way in at the same depth";
}

}  // namespace

std::vector<ConformanceTest> stepTests() {
  return {
      {"finite-outputs", "every answer is finite, whatever the probe does", &finiteOutputs, kInTime},
      {"bad-sample", "a bad sample gets no force", &badSample, kFinite},
      {"force-continuous", "forces follow the claimed stiffness", &forceContinuous, kFinite},
      {"normal-unit-length", "normals are unit vectors", &normalUnit, kFinite},
      {kRests, "a shape that moves stays where it is in a step of 0 s", &restsInNoTime, kFinite},
      {"depth-falls-outward", "depth falls where the probe moves along the outward normal", &depthOutward, kRests},
      {"energy-non-increasing", "a closed path gives no energy", &energyNonIncreasing, kRests},
  };
}

}  // namespace hapticd::conformance
