// SPDX-License-Identifier: MIT
/// Measures cost and error of the servo's rate, search radius and velocity estimator, each by itself. Their errors are
/// of another kind than the errors of shapes: for example, a force that is late.
#pragma once
#include <string>
#include <vector>

#include "tune/measurement.hpp"

namespace hapticd::tune {

struct RateRow {
  double rate = 0;          ///< [Hz]
  double load = 0;          ///< share of one processor: median tick time multiplied by the rate
  double hold_error_n = 0;  ///< [N] p99 of the difference between held force and force at 10 kHz
  bool current = false;
};

/// [main] Measures the scene at 500 Hz to 10 kHz, over the same motion.
Result<std::vector<RateRow>> measureRates(const scene::Scene& scene, const Motion& motion,
                                          const host::Services::Log& log);

struct RadiusRow {
  double radius = 0;   ///< [m] activation radius
  double tick_ns = 0;  ///< [ns] median time of a tick
  Difference error;    ///< difference from the answers with the widest radius
  bool current = false;
};

/// [main] Measures activation radii from 1 cm to 20 cm, over the same motion.
Result<std::vector<RadiusRow>> measureRadii(const scene::Scene& scene, const Motion& motion,
                                            const host::Services::Log& log);

struct EstimatorRow {
  std::string estimator;   ///< name and parameter, such as "window 3"
  double tick_ns = 0;      ///< [ns] median time of a tick with this estimator
  double force_p99_n = 0;  ///< [N] p99 of the difference from the force with the true velocity
  double force_max_n = 0;  ///< [N] largest difference, which is at an impact
  bool current = false;
};

/// [main] Measures several estimators over the same motion.
Result<std::vector<EstimatorRow>> measureEstimators(const scene::Scene& scene, const Motion& motion,
                                                    const host::Services::Log& log);

}  // namespace hapticd::tune
