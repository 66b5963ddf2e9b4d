// SPDX-License-Identifier: MIT
/// The largest force along a direction that gives no more than a certain power to the hand, until the next command: the
/// velocity is an estimate that lags, the hand may accelerate meanwhile, and the force itself accelerates it.
#pragma once
#include <Eigen/Core>

#include "hapticd/abi.h"

namespace hapticd::servo {

class PowerBound {
 public:
  static constexpr double kMargin = 1.5;     ///< of the accelerations that were seen: the next may be larger
  static constexpr double kRemember = 0.02;  ///< [s] after which they are forgotten

  /// [main] @param lag [s] of the velocity estimate  @param mass [kg] of the arm at its tip; 0: the force accelerates
  /// it by nothing
  void expect(double lag, double mass) {
    lag_ = lag;
    mass_ = mass;
  }

  /// [rt] A new estimate [m/s]; one that is not a number counts as rest.
  void watch(const Eigen::Vector3d& velocity) noexcept HSP_RT;

  /// [rt] Once a tick. @param dt [s] since the last tick, taken for the time to the next too
  void pass(double dt) noexcept HSP_RT;

  /// [rt] The largest force [N] along `direction` (unit) that stays within `power` [W]; infinite if the hand moves
  /// against it.
  double most(const Eigen::Vector3d& direction, double power) const noexcept HSP_RT;

 private:
  double lag_ = 0, mass_ = 0;
  double acceleration_ = 0;  // [m/s^2] the largest recent one
  double age_ = 0, dt_ = 0;  // [s] of the estimate, and of a tick
  bool known_ = false;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace hapticd::servo
