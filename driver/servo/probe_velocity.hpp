/// The velocity estimator that a scene asks for.
#pragma once
#include <stdexcept>

#include "base/result.hpp"
#include "scene/scene.hpp"
#include "servo/velocity/estimator.hpp"

namespace hapticd::servo {

using velocity::VelocityEstimator;

/// [main] @param rate [Hz] of the samples  @param resolution [m] of a position; 0: unknown
inline Result<VelocityEstimator> makeEstimator(const scene::Velocity& how, double rate, double resolution = 0) {
  try {
    return velocity::make(how.estimator, how.parameter, rate, resolution > 0 ? resolution : velocity::kResolution);
  } catch (const std::invalid_argument& e) {
    return Error{std::string("servo.velocity: ") + e.what()};
  }
}

}  // namespace hapticd::servo
