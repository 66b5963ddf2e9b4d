// SPDX-License-Identifier: MIT
/// The motion of the probe over which settings are measured.
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
  /// [m/s] Velocity by least squares over samples before and after; an estimator in a servo has only the samples
  /// before.
  std::vector<Eigen::Vector3d> velocity;
};

/// [main] Returns the motion of the scene's simulated hand in the closed loop, for at most ten seconds.
Result<Motion> motionOfHand(const scene::Scene& scene, double seconds, const host::Services::Log& log);

/// [main] Makes a motion through given positions.
Motion motionThrough(std::vector<Eigen::Vector3d> position, double period);

/// [main] Returns the same motion at another rate [Hz], by cubic interpolation.
Motion resampled(const Motion& motion, double rate);

}  // namespace hapticd::tune
