// SPDX-License-Identifier: MIT
/// Estimates the velocity of a probe with the estimator that servo.velocity of the scene names.
#pragma once
#include <Eigen/Core>
#include <stdexcept>

#include "base/result.hpp"
#include "description/scene.hpp"
#include "servo/velocity/estimator.hpp"

namespace hapticd::servo {

using velocity::VelocityEstimator;

/// [m/s] twice the speed of a hand; if a sample needs a higher speed, it is a jump
inline constexpr double kMaxProbeSpeed = 20;

/// [main] Makes the estimator that servo.velocity names. @param rate [Hz] of the samples @param resolution [m] of a
/// position; 0: unknown
inline Result<VelocityEstimator> makeEstimator(const scene::Velocity& how, double rate, double resolution = 0) {
  try {
    return velocity::make(how.estimator, how.parameter, rate, resolution > 0 ? resolution : velocity::kResolution);
  } catch (const std::invalid_argument& e) {
    return Error{std::string("servo.velocity: ") + e.what()};
  }
}

/// Estimates the velocity of a probe, and restarts the estimator after a gap or a jump. Otherwise the difference
/// between the positions before and after the jump would become a velocity, and damping would push the hand until the
/// estimator has forgotten this difference.
class ProbeVelocity {
 public:
  explicit ProbeVelocity(const VelocityEstimator& estimator) : estimator_(estimator) {}

  /// [rt] Takes a sample and returns the velocity [m/s]: zero after a gap or a jump. @param position [m]
  /// @param dt [s] since the last sample
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept {
    const double moved = known_ ? (position - last_).norm() : 0;
    speed_ = dt > 0 ? moved / dt : 0;
    if (!(moved <= kMaxProbeSpeed * dt)) estimator_.reset();
    known_ = true;
    last_ = position;
    return estimator_.update(position, dt);
  }

  void reset() noexcept {  ///< [rt] called if this tick has no good sample
    known_ = false;
    estimator_.reset();
  }

  /// [rt] Returns the speed [m/s] between the last two samples, even if it is that of a jump.
  double speed() const noexcept { return speed_; }

 private:
  VelocityEstimator estimator_;
  Eigen::Vector3d last_ = Eigen::Vector3d::Zero();
  double speed_ = 0;
  bool known_ = false;
};

}  // namespace hapticd::servo
