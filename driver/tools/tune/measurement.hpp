// SPDX-License-Identifier: MIT
/// Cost and error of one setting: the servo core run over a motion, timed, and compared with a reference.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "host/services.hpp"
#include "tune/motion.hpp"

namespace hapticd::tune {

/// What one model answered in one tick; world frame.
struct Answer {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = point, force = point;  ///< [m], unit, [N]
  double depth = 0;                                                                ///< [m] > 0 inside
  bool traced = false;
};

struct Cost {
  double p50_ns = 0, p99_ns = 0;  ///< time of a tick of the core with all models, velocity estimation included
  /// The medians of its passes lie between these, which never count as more exact than kCostNoise.
  double p50_low_ns = 0, p50_high_ns = 0;
  uint64_t bytes = 0;  ///< bytes that the models hold in locked memory
};

struct Run {
  std::vector<Answer> answers;  ///< [tick * models + model]
  size_t models = 0;
  Cost cost;
};

/// Largest difference from the reference, over every tick and model. Where a probe is equally near to two places of
/// a model, as between the faces of a leaf, either foot is right: there only depths and sizes of forces are
/// compared.
struct Difference {
  double foot_m = 0;  ///< where the nearest foot is one point
  double depth_m = 0;
  double normal_deg = 0;   ///< as foot_m
  double force_n = 0;      ///< of one model
  uint64_t ambiguous = 0;  ///< answers at another foot that is equally near
  uint64_t untraced = 0;   ///< answers that only one of the two has

  double geometry() const { return untraced > 0 ? 1 : std::max(foot_m, depth_m); }  ///< [m] 1 m: nothing was traced
};

constexpr double kCostNoise = 0.05;  ///< relative: timings of the same thing differ at least by this

/// Adds another measurement of the same setting: the least disturbed one counts, and the interval includes both.
void widen(Cost& cost, const Cost& again);

enum class VelocityFrom { kEstimator, kMotion };

/// [main] The answers over a motion; the costs are those of this one pass.
Result<Run> answer(const scene::Scene& scene, const Motion& motion, VelocityFrom velocity,
                   const host::Services::Log& log);

/// [main] Answers with the motion's own velocity, so that the estimator's error does not count as another setting's;
/// costs with the scene's estimator, from the least disturbed of `passes`.
Result<Run> measure(const scene::Scene& scene, const Motion& motion, int passes, const host::Services::Log& log);

/// [main] Both runs are of the same motion and models.
Difference compare(const Run& run, const Run& reference);

}  // namespace hapticd::tune
