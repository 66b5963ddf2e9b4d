// SPDX-License-Identifier: MIT
/// A velocity estimator by name.
#pragma once
#include <Eigen/Core>
#include <string_view>
#include <variant>

#include "servo/velocity/filters.hpp"

namespace hapticd::velocity {

constexpr double kResolution = 30e-6;  ///< [m] of a PHANToM Premium; what is assumed where the device says nothing

/// One of the estimators. Copies are independent.
class VelocityEstimator {
 public:
  using Filter = std::variant<Window, Butterworth, AdaptiveWindow, LeastSquares, Kalman>;
  explicit VelocityEstimator(Filter filter) : filter_(std::move(filter)) {}  ///< [main]

  /// [rt] Takes a position [m], `dt` [s] after the last one (0 for the first); gives the velocity [m/s], zero until two
  /// are known. A position that is not finite, or dt that is not positive, changes nothing and repeats the last answer.
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;
  void reset() noexcept;  ///< [rt] forgets the past

 private:
  Filter filter_;
  Eigen::Vector3d velocity_{0, 0, 0};
  bool started_ = false;
};

/// [main] By name and knob:
///   window        n of Eq. 5, samples            butterworth   cut-off [Hz]
///   foaw          longest window, samples        least_squares samples, at least 3
///   kalman        density of the white jerk [m^2/s^5]
/// @param rate [Hz] of the samples  @param resolution [m] of a measured position (foaw and kalman)
/// @throws std::invalid_argument that says what was expected.
VelocityEstimator make(std::string_view name, double parameter, double rate, double resolution = kResolution);

}  // namespace hapticd::velocity
