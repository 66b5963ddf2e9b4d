// SPDX-License-Identifier: MIT
/// Calculates the largest force along a direction that gives at most a certain power to the hand until the next
/// command. It allows for three effects: the velocity is an estimate that lags, the hand may accelerate meanwhile, and
/// the force itself accelerates the arm.
#pragma once
#include <Eigen/Core>

#include "hapticd/abi.h"

namespace hapticd::servo {

class PowerBound {
 public:
  /// factor on the largest recent acceleration, because the next acceleration may be larger
  static constexpr double kMargin = 1.5;
  static constexpr double kRemember = 0.02;  ///< [s] time after which an acceleration is forgotten

  /// [main] @param lag [s] delay of the velocity estimate @param mass [kg] of the arm at its tip; 0: unknown, so the
  /// acceleration of the arm by the force is not counted
  void expect(double lag, double mass) {
    lag_ = lag;
    mass_ = mass;
  }

  /// [rt] Takes a new velocity estimate [m/s]. An estimate that is not finite counts as zero.
  void watch(const Eigen::Vector3d& velocity) noexcept HSP_RT;

  /// [rt] Called once per tick. @param dt [s] since the last tick; the next tick is assumed to come after the same time
  void pass(double dt) noexcept HSP_RT;

  /// [rt] Returns the largest force [N] along `direction` (unit) that stays within `power` [W]; infinite if the hand
  /// moves against the force.
  double most(const Eigen::Vector3d& direction, double power) const noexcept HSP_RT;

 private:
  double lag_ = 0, mass_ = 0;
  double acceleration_ = 0;  // [m/s^2] largest recent acceleration
  double age_ = 0, dt_ = 0;  // [s] age of the estimate; duration of a tick
  bool known_ = false;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace hapticd::servo
