// SPDX-License-Identifier: MIT
#include "tune/sweeps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace hapticd::tune {
namespace {

constexpr double kNear = 0.01;  // [m] as far as a fast hand moves between two searches; what is nearer must be traced
constexpr double kFastest = 10'000;  // [Hz] the rate with whose forces those of other rates are compared

/// Returns the sum of the forces of all models, which the hand feels.
Eigen::Vector3d forceAt(const Run& run, size_t tick) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < run.models; ++i) force += run.answers[tick * run.models + i].force;
  return force;
}

double p99(std::vector<double>& errors) {
  const auto at = errors.begin() + static_cast<long>(0.99 * static_cast<double>(errors.size() - 1));
  std::nth_element(errors.begin(), at, errors.end());
  return *at;
}

/// Returns the p99 of the difference between a force that is held for a period and the force at the fastest rate.
double holdError(const Run& slow, double rate, const Run& fast) {
  std::vector<double> errors;
  const size_t slow_ticks = slow.answers.size() / slow.models, fast_ticks = fast.answers.size() / fast.models;
  for (size_t i = 0; i < fast_ticks; ++i) {
    const size_t held = std::min(static_cast<size_t>(static_cast<double>(i) * rate / kFastest + 1e-9), slow_ticks - 1);
    errors.push_back((forceAt(slow, held) - forceAt(fast, i)).norm());
  }
  return p99(errors);
}

/// The estimators to measure, with parameters that suit a servo rate of 1 kHz.
const std::vector<scene::Velocity> kEstimators = {{"window", 1},       {"window", 3}, {"window", 10},
                                                  {"butterworth", 50}, {"foaw", 15},  {"least_squares", 8},
                                                  {"kalman", 100}};

}  // namespace

Result<std::vector<RateRow>> measureRates(const scene::Scene& scene, const Motion& motion,
                                          const host::Services::Log& log) {
  auto fast = answer(scene, resampled(motion, kFastest), VelocityFrom::kMotion, log);
  if (!fast) return Error{fast.error()};
  std::vector<double> rates = {500, 1000, 2000, 5000, kFastest};
  if (std::find(rates.begin(), rates.end(), scene.servo.rate) == rates.end()) rates.push_back(scene.servo.rate);
  std::sort(rates.begin(), rates.end());
  std::vector<RateRow> rows;
  for (const double rate : rates) {
    auto run = answer(scene, resampled(motion, rate), VelocityFrom::kMotion, log);
    if (!run) return Error{run.error()};
    rows.push_back({rate, run->cost.p50_ns * 1e-9 * rate, holdError(*run, rate, *fast), rate == scene.servo.rate});
  }
  return rows;
}

Result<std::vector<RadiusRow>> measureRadii(const scene::Scene& scene, const Motion& motion,
                                            const host::Services::Log& log) {
  std::vector<double> radii = {0.01, 0.02, 0.05, 0.1, 0.2};
  if (std::find(radii.begin(), radii.end(), scene.servo.activation_radius) == radii.end())
    radii.push_back(scene.servo.activation_radius);
  std::sort(radii.rbegin(), radii.rend());
  std::vector<RadiusRow> rows;
  std::optional<Run> widest;
  for (const double radius : radii) {
    scene::Scene other = scene;
    other.servo.activation_radius = radius;
    auto run = answer(other, motion, VelocityFrom::kMotion, log);
    if (!run) return Error{run.error()};
    if (!widest) widest = *run;
    rows.push_back({radius, run->cost.p50_ns, compare(*run, *widest, kNear), radius == scene.servo.activation_radius});
  }
  return rows;
}

Result<std::vector<EstimatorRow>> measureEstimators(const scene::Scene& scene, const Motion& motion,
                                                    const host::Services::Log& log) {
  auto truth = answer(scene, motion, VelocityFrom::kMotion, log);
  if (!truth) return Error{truth.error()};
  std::vector<scene::Velocity> estimators = kEstimators;
  const auto same = [&](const scene::Velocity& v) {
    return v.estimator == scene.servo.velocity.estimator && v.parameter == scene.servo.velocity.parameter;
  };
  if (std::none_of(estimators.begin(), estimators.end(), same))
    estimators.insert(estimators.begin(), scene.servo.velocity);
  std::vector<EstimatorRow> rows;
  for (const scene::Velocity& velocity : estimators) {
    scene::Scene other = scene;
    other.servo.velocity = velocity;
    auto run = answer(other, motion, VelocityFrom::kEstimator, log);
    if (!run) return Error{run.error()};
    std::vector<double> errors;
    for (size_t i = 0; i < motion.position.size(); ++i)
      errors.push_back((forceAt(*run, i) - forceAt(*truth, i)).norm());
    const double worst = *std::max_element(errors.begin(), errors.end());
    rows.push_back({fmt::format("{} {:g}", velocity.estimator, velocity.parameter), run->cost.p50_ns, p99(errors),
                    worst, same(velocity)});
  }
  return rows;
}

}  // namespace hapticd::tune
