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
  double load = 0;          ///< share of one processor: median tick time multiplied by the rate
  double hold_error_n = 0;  ///< [N] p99 of the force change that a held output misses, compared with 10 kHz
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
  double tick_ns = 0;      ///< median time of a tick with it
  double force_p99_n = 0;  ///< [N] error of the force, compared with that of the true velocity
  double force_max_n = 0;  ///< the same in the worst case, which is an impact
  bool current = false;
};

/// [main] The estimators over the same motion; none if no model reads a velocity.
Result<std::vector<EstimatorRow>> measureEstimators(const scene::Scene& scene, const Motion& motion,
                                                    const host::Services::Log& log);

}  // namespace hapticd::tune
