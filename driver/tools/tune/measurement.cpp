// SPDX-License-Identifier: MIT
#include "tune/measurement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/clock.hpp"
#include "base/offline_tick.hpp"
#include "servo/loop/lockstep.hpp"
#include "servo/velocity/probe_velocity.hpp"
#include "world/world.hpp"

namespace hapticd::tune {
namespace {

void keep(const servo::Core& core, std::vector<Answer>& answers) {
  for (uint32_t i = 0; i < core.models().size(); ++i) {
    const servo::Contact& contact = core.contact(i, 0);
    Answer answer;
    answer.point = Eigen::Vector3d(contact.world.point);
    answer.normal = Eigen::Vector3d(contact.world.normal);
    answer.force = Eigen::Vector3d(contact.world.force);
    answer.depth = contact.world.depth_m;
    answer.traced = contact.traced;
    answers.push_back(answer);
  }
}

double quantile(std::vector<double>& times, double share) {
  const auto at = times.begin() + static_cast<long>(share * static_cast<double>(times.size() - 1));
  std::nth_element(times.begin(), at, times.end());
  return *at;
}

/// Runs the scene once over the motion, one tick per sample, and returns the times per tick and the memory. Appends
/// the answer of each model in each tick to `answers`, unless it is nullptr.
Result<Cost> pass(const scene::Scene& scene, const Motion& motion, VelocityFrom from, std::vector<Answer>* answers,
                  const host::Services::Log& log) {
  auto world = servo::World::build(scene, {.rate = 1 / motion.period}, log);
  if (!world) return Error{world.error()};
  std::optional<servo::ProbeVelocity> estimator;
  if ((*world)->needsVelocity() && from == VelocityFrom::kEstimator) {
    auto made = servo::makeEstimator(scene.servo.velocity, 1 / motion.period);
    if (!made) return Error{made.error()};
    estimator.emplace(*made);
  }
  servo::Lockstep lockstep = (*world)->lockstep();
  servo::Core& core = (*world)->core();
  servo::Probe probe;
  probe.valid = true;
  std::vector<double> times;
  for (size_t i = 0; i < motion.position.size(); ++i) {
    const double t = static_cast<double>(i) * motion.period, dt = i == 0 ? 0 : motion.period;
    probe.position = motion.position[i];
    if (from == VelocityFrom::kMotion) probe.velocity = motion.velocity[i];
    const OfflineTick counted;
    core.publish(t, {&probe, 1});
    lockstep.before(t);
    const Nanoseconds begun = monotonicNow();
    if (estimator) probe.velocity = estimator->update(probe.position, dt);
    core.tick(t, dt, {&probe, 1});
    times.push_back(static_cast<double>(monotonicNow() - begun));
    if (answers != nullptr) keep(core, *answers);
  }
  Cost cost;
  cost.p50_ns = cost.p50_low_ns = cost.p50_high_ns = quantile(times, 0.5);
  cost.p99_ns = quantile(times, 0.99);
  cost.bytes = (*world)->lockedBytes();
  return cost;
}

/// Returns true if the two foot points are more than a millimetre apart and equally near to the probe, because it is on
/// the medial axis there. A foot on the same face that is wrong by so much would differ far more in its distance,
/// because the distance grows with the square of the error.
bool ambiguous(const Answer& a, const Answer& b) {
  constexpr double kApart = 1e-3, kShare = 1e-3;  // [m]; share of the distance between the feet
  const double foot = (a.point - b.point).norm();
  return a.traced && b.traced && foot > kApart && std::abs(a.depth - b.depth) < kShare * foot;
}

}  // namespace

void widen(Cost& cost, const Cost& again) {
  cost.p50_ns = cost.p50_low_ns = std::min(cost.p50_low_ns, again.p50_low_ns);
  cost.p99_ns = std::min(cost.p99_ns, again.p99_ns);
  cost.p50_high_ns = std::max({cost.p50_high_ns, again.p50_high_ns, cost.p50_low_ns * (1 + kCostNoise)});
}

Result<Run> answer(const scene::Scene& scene, const Motion& motion, VelocityFrom velocity,
                   const host::Services::Log& log) {
  Run run;
  run.models = scene.models.size();
  auto cost = pass(scene, motion, velocity, &run.answers, log);
  if (!cost) return Error{cost.error()};
  run.cost = *cost;
  return run;
}

Result<Run> measure(const scene::Scene& scene, const Motion& motion, int passes, const host::Services::Log& log) {
  auto run = answer(scene, motion, VelocityFrom::kMotion, log);
  if (!run) return run;
  for (int i = 0; i < passes; ++i) {
    auto cost = pass(scene, motion, VelocityFrom::kEstimator, nullptr, log);
    if (!cost) return Error{cost.error()};
    if (i == 0) run->cost = *cost;
    widen(run->cost, *cost);
  }
  return run;
}

Difference compare(const Run& run, const Run& reference, double near) {
  Difference difference;
  for (size_t i = 0; i < std::min(run.answers.size(), reference.answers.size()); ++i) {
    const Answer &a = run.answers[i], &b = reference.answers[i];
    const bool either = ambiguous(a, b);
    const double force = either ? std::abs(a.force.norm() - b.force.norm()) : (a.force - b.force).norm();
    difference.force_n = std::max(difference.force_n, force);
    if (a.traced != b.traced && (a.traced ? a : b).depth > -near) ++difference.untraced;
    if (!a.traced || !b.traced) continue;
    difference.depth_m = std::max(difference.depth_m, std::abs(a.depth - b.depth));
    difference.ambiguous += either;
    if (either) continue;
    const double foot = (a.point - b.point).norm();
    difference.foot_m = std::max(difference.foot_m, foot);
    const double cosine = std::clamp(a.normal.dot(b.normal), -1.0, 1.0);
    difference.normal_deg = std::max(difference.normal_deg, std::acos(cosine) * 180 / std::numbers::pi);
  }
  return difference;
}

}  // namespace hapticd::tune
