// SPDX-License-Identifier: MIT
/// Velocity estimators, made by name.
#pragma once
#include <Eigen/Core>
#include <string_view>
#include <variant>

#include "servo/velocity/filters.hpp"

namespace hapticd::velocity {

constexpr double kResolution = 30e-6;  ///< [m] resolution of a PHANToM Premium; assumed if the device reports none

/// A velocity estimator of any kind. Copies are independent.
class VelocityEstimator {
 public:
  using Filter = std::variant<Window, Butterworth, AdaptiveWindow, LeastSquares, Kalman>;
  explicit VelocityEstimator(Filter filter) : filter_(std::move(filter)) {}  ///< [main]

  /// [rt] Takes a position [m], `dt` [s] after the last one (0 for the first). Returns the velocity [m/s], zero until
  /// two positions are known. A position that is not finite, or a dt that is not positive, is ignored: the last
  /// velocity is returned again.
  Eigen::Vector3d update(const Eigen::Vector3d& position, double dt) noexcept;
  void reset() noexcept;  ///< [rt] forgets all positions

 private:
  Filter filter_;
  Eigen::Vector3d velocity_{0, 0, 0};
  bool started_ = false;
};

/// [main] Makes an estimator. The meaning of `parameter` depends on `name`:
///   window        n of Eq. 5, samples            butterworth   cut-off [Hz]
///   foaw          longest window, samples        least_squares samples, at least 3
///   kalman        density of the white jerk [m^2/s^5]
/// @param rate [Hz] of the samples  @param resolution [m] of a measured position (foaw and kalman)
/// @throws std::invalid_argument with a text that says what was expected.
VelocityEstimator make(std::string_view name, double parameter, double rate, double resolution = kResolution);

}  // namespace hapticd::velocity
