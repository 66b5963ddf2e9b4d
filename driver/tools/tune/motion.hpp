// SPDX-License-Identifier: MIT
/// The probe motion that settings are measured with.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "host/services.hpp"

namespace hapticd::tune {

struct Motion {
  double period = 1e-3;                   ///< [s]
  std::vector<Eigen::Vector3d> position;  ///< [m] world, one sample per period
  /// [m/s] by least squares over samples before and after, which no estimator in a servo can know.
  std::vector<Eigen::Vector3d> velocity;
};

/// [main] What the scene's simulated hand does in the closed loop, for at most ten seconds.
Result<Motion> motionOfHand(const scene::Scene& scene, double seconds, const host::Services::Log& log);

/// [main] A motion through given positions.
Motion motionThrough(std::vector<Eigen::Vector3d> position, double period);

/// [main] The same motion at another rate [Hz], by cubic interpolation.
Motion resampled(const Motion& motion, double rate);

}  // namespace hapticd::tune
