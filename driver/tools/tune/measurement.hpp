// SPDX-License-Identifier: MIT
/// Measures cost and error of one setting: runs the servo core over a motion, takes the time, and compares the answers
/// with a reference.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "host/services.hpp"
#include "tune/motion.hpp"

namespace hapticd::tune {

/// The answer of one model in one tick, in the world frame.
struct Answer {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = point, force = point;  ///< [m], unit, [N]
  double depth = 0;  ///< [m] penetration depth, positive inside
  bool traced = false;
};

struct Cost {
  double p50_ns = 0, p99_ns = 0;  ///< [ns] time of a tick of the core with all models, including velocity estimation
  /// [ns] Smallest and largest median of all measurements; at least kCostNoise apart after widen().
  double p50_low_ns = 0, p50_high_ns = 0;
  uint64_t bytes = 0;  ///< memory that the models hold locked
};

struct Run {
  std::vector<Answer> answers;  ///< [tick * models + model]
  size_t models = 0;
  Cost cost;
};

/// Largest difference from the reference, over every tick and model. If a probe is equally near to two places of a
/// model, as in the middle between the faces of a thin sheet, either foot is right. Then only depths and sizes of
/// forces are compared.
struct Difference {
  double foot_m = 0;  ///< [m] only where there is a single nearest point
  double depth_m = 0;
  double normal_deg = 0;   ///< only where there is a single nearest point
  double force_n = 0;      ///< [N] force of a single model
  uint64_t ambiguous = 0;  ///< number of answers with another foot point that is equally near
  uint64_t untraced = 0;   ///< number of answers that have a foot point in only one of the two runs
  /// [m] larger of foot_m and depth_m; 1 m if a surface was traced in only one of the two runs
  double geometry() const { return untraced > 0 ? 1 : std::max(foot_m, depth_m); }
};

constexpr double kCostNoise = 0.05;  ///< two measurements of the same time are assumed to differ at least by this share

/// Adds another measurement of the same setting. The cost keeps the shorter times, and its interval is extended to
/// include both medians.
void widen(Cost& cost, const Cost& again);

enum class VelocityFrom { kEstimator, kMotion };

/// [main] Returns the answers over a motion. The cost is that of a single pass.
Result<Run> answer(const scene::Scene& scene, const Motion& motion, VelocityFrom velocity,
                   const host::Services::Log& log);

/// [main] Returns the answers of a setting and its cost. The answers are computed with the motion's own velocity, so
/// that errors of the velocity estimator do not count as errors of the setting. The cost is measured with the scene's
/// estimator, as the shortest of `passes` measurements.
Result<Run> measure(const scene::Scene& scene, const Motion& motion, int passes, const host::Services::Log& log);

/// [main] Compares two runs over the same motion with the same models. @param near [m] a foot farther away than this
/// need not be traced in both runs
Difference compare(const Run& run, const Run& reference, double near = HUGE_VAL);

}  // namespace hapticd::tune
