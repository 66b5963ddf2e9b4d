// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <random>

#include "conformance/conformance_parts.hpp"
#include "conformance/lock_count.hpp"
#include "servo/safety/claim.hpp"
#include "servo/safety/guard.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

std::string noAllocation(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  along(*made.subject, [](const Answer&, const Vector3d&) { return ""; });
  const uint64_t count = made.subject->allocations();
  return count == 0 ? "" : std::to_string(count) + " allocations in " + std::to_string(kConformanceSteps) + " steps";
}

std::string noLock(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (!countLocksOf(recipe.file)) return "skip: the file imports no lock function, or cannot be read";
  uint64_t locks = 0;
  for (int i = 0; i < kConformanceSteps; ++i) {
    const Vector3d p = onPath(*made.subject, static_cast<double>(i) / kConformanceSteps);
    const uint64_t before = locksCounted();
    made.subject->step({p}, kConformanceDt);
    locks += i % 5 != 0 ? locksCounted() - before : 0;  // searches belong to another thread, which may lock
  }
  return locks == 0 ? "" : std::to_string(locks) + " locks in " + std::to_string(kConformanceSteps) + " steps";
}

std::string stepCost(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const uint64_t claim = std::max(made.subject->report().worst_ns, made.subject->report().typical_ns);
  if (claim == 0) return "skip: the plugin claims no cost";
  std::vector<uint64_t> spent;
  along(*made.subject, [&](const Answer&, const Vector3d&) {
    spent.push_back(made.subject->stepNs());
    return "";
  });
  std::nth_element(spent.begin(), spent.begin() + static_cast<long>(spent.size() / 2), spent.end());
  const uint64_t p50 = spent[spent.size() / 2];
  return p50 <= claim
             ? ""
             : "a step takes " + std::to_string(p50) + " ns (median); the claimed worst is " + std::to_string(claim);
}

std::string finiteOutputs(const Recipe& recipe, uint64_t seed) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const auto look = [](const Answer& answer, const Vector3d&) { return wrongStatus(answer); };
  if (std::string wrong = along(*made.subject, look); !wrong.empty()) return wrong;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> step(0, 1e-3);
  Vector3d p = onPath(*made.subject, 0.3);
  for (int i = 0; i < kConformanceSteps; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    if (std::string wrong = wrongStatus(made.subject->step({p}, kConformanceDt)); !wrong.empty())
      return wrong + " on a random walk";
  }
  hsp_probe bad{};
  for (double& x : bad.position) x = std::nan("");
  bad.orientation[0] = 1;
  bad.flags = HSP_IN_INVALID;
  const Answer& answer = made.subject->stepRaw(bad, kConformanceDt);
  if (!finite(answer)) return "the answer to a bad sample is not finite";
  if (Vector3d(answer.contacts[0].force).norm() > 0) return "the answer to a bad sample has a force";
  if (std::string wrong = wrongStatus(made.subject->step({p}, kConformanceDt)); !wrong.empty())
    return wrong + " after a bad sample";
  return "";
}

std::string forceContinuous(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (!(made.subject->report().max_stiffness > 0)) return "skip: no stiffness is claimed";
  const hsp_report& report = made.subject->report();
  servo::ClaimBounds bounds;
  bounds.stiffness = report.max_stiffness;
  bounds.damping = made.subject->damping();
  bounds.jump = (report.flags & HSP_R_JUMPS) != 0 ? report.max_jump : 0;
  servo::Claim claim;
  int jumps = 0;
  Vector3d last = Vector3d::Zero();
  return along(*made.subject, [&](const Answer& answer, const Vector3d& p) {
    const hsp_contact& contact = answer.contacts[0];
    servo::ClaimStep step;
    step.force = Vector3d(contact.force);
    step.normal = Vector3d(contact.normal);
    step.p_world = step.p_model = p;
    step.velocity = (p - last) / kConformanceDt;
    step.out = contact.flags;
    step.in = answer.jumped ? HSP_IN_JUMP : 0;
    if (answer.jumped) step.velocity.setZero();
    last = p;
    bool held = false;
    claim.judge(step, bounds, kConformanceDt, held);
    jumps += held ? 1 : 0;
    return std::string(jumps >= 3 ? "the force jumped beyond the claimed stiffness three times" : "");
  });
}

std::string normalUnit(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  return along(*made.subject, [](const Answer& answer, const Vector3d&) {
    const hsp_contact& c = answer.contacts[0];
    const double norm = Vector3d(c.normal).norm();
    const bool traced = (c.flags & HSP_OUT_TRACED) != 0;
    return traced && std::abs(norm - 1) > 1e-6 ? "a normal of length " + text(norm) : std::string();
  });
}

/// Where the probe moves along the normal, depth falls by as much: else depth or normal has the wrong sign, and with it
/// the force that is made of them.
std::string depthOutward(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (made.subject->moves()) return "skip: it moves, and its depth with it";
  double agrees = 0, depth = 0;
  Vector3d last = Vector3d::Zero();
  bool known = false;
  along(*made.subject, [&](const Answer& answer, const Vector3d& p) {
    const hsp_contact& c = answer.contacts[0];
    const bool traced = (c.flags & HSP_OUT_TRACED) != 0;
    known = known && !answer.jumped;
    const double out = Vector3d(c.normal).dot(p - last), way = (p - last).norm();
    if (traced && known) agrees -= out * std::clamp(c.depth_m - depth, -way, way);
    known = traced;
    depth = c.depth_m;
    last = p;
    return std::string();
  });
  return agrees >= 0 ? "" : "depth grows toward the outward normal: depth or normal has the wrong sign";
}

std::string energyNonIncreasing(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const double before = made.subject->energy();
  if (made.subject->moves() && std::isnan(before)) return "skip: it moves and does not report its stored energy";
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
  if (made.subject->moves()) return "";  // gravity and the hand both work on it: bounded by the test of its own energy
  const double gained = std::isnan(before) ? 0 : made.subject->energy() - before;
  constexpr double kRounding = 0.02;  // of the work that went to and fro: the path is walked in steps
  const double allowed = kRounding * moved + 1e-6 - gained;
  return given <= allowed ? "" : "a closed path gave " + text(given) + " J to the hand of " + text(moved) + " J moved";
}

}  // namespace

std::vector<ConformanceTest> stepTests() {
  return {
      {"no-allocation-in-step", "steps do not allocate", &noAllocation},
      {"no-lock-in-step", "steps do not lock", &noLock},
      {"step-cost-vs-claim", "steps take no longer than claimed", &stepCost},
      {"finite-outputs", "every answer is finite, whatever the probe does", &finiteOutputs},
      {"force-continuous", "forces follow the claimed stiffness", &forceContinuous},
      {"normal-unit-length", "normals are unit vectors", &normalUnit},
      {"depth-falls-outward", "depth falls where the probe moves along the outward normal", &depthOutward},
      {"energy-non-increasing", "a closed path gives no energy", &energyNonIncreasing},
  };
}

}  // namespace hapticd::conformance
