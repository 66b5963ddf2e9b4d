// SPDX-License-Identifier: MIT
/// What the servo's rate and its velocity estimator cost and give, each by itself: their errors are of another kind
/// than those of the shapes, a force that is late.
#pragma once
#include <string>
#include <vector>

#include "tune/measurement.hpp"

namespace hapticd::tune {

struct RateRow {
  double rate = 0;          ///< [Hz]
  double load = 0;          ///< share of one processor: median tick times rate
  double hold_error_n = 0;  ///< [N] p99 of the change of force that a held output misses, against 10 kHz
  bool current = false;
};

/// [main] The scene at 500 Hz to 10 kHz, over the same motion.
Result<std::vector<RateRow>> measureRates(const scene::Scene& scene, const Motion& motion,
                                          const host::Services::Log& log);

struct RadiusRow {
  double radius = 0;   ///< [m]
  double tick_ns = 0;  ///< median
  Difference error;    ///< from the widest radius
  bool current = false;
};

/// [main] Activation radii from 1 cm to 20 cm, over the same motion.
Result<std::vector<RadiusRow>> measureRadii(const scene::Scene& scene, const Motion& motion,
                                            const host::Services::Log& log);

struct EstimatorRow {
  std::string estimator;   ///< "window 3"
  double tick_ns = 0;      ///< median of a tick with it
  double force_p99_n = 0;  ///< [N] error of the force, against the velocity that the motion really has
  double force_max_n = 0;  ///< the same at its worst, which is an impact
  bool current = false;
};

/// [main] The estimators over the same motion; none where no model reads a velocity.
Result<std::vector<EstimatorRow>> measureEstimators(const scene::Scene& scene, const Motion& motion,
                                                    const host::Services::Log& log);

}  // namespace hapticd::tune
