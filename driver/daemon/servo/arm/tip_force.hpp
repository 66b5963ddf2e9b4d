// SPDX-License-Identifier: MIT
/// Calculates the force at the tip from measured joint torques.
#pragma once
#include <Eigen/Core>

#include "hapticd/device.h"

namespace hapticd::servo {

/// Maps joint rates to the velocity of the tip: three rows x, y, z in the device frame, one column per joint.
using TipJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, HDV_MAX_JOINTS>;
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, HDV_MAX_JOINTS, 1>;

/// Inverts J J^T of a tip, also near singular poses. Directions in which the arm can hardly move are damped (Nakamura &
/// Hanafusa 1986), so that along them a result stays bounded and fades to zero.
class TipInverse {
 public:
  static constexpr double kDamped = 0.05;  ///< singular values below this fraction of the largest are damped

  /// [rt] Factorizes J J^T.
  explicit TipInverse(const TipJacobian& J) noexcept;

  /// [rt] Returns pinv(J) v: the smallest joint rates that move the tip with velocity v.
  JointVector rates(const Eigen::Vector3d& velocity) const noexcept;
  /// [rt] Returns pinv(J^T) tau: the force at the tip that explains the torques best (inverts Thompson et al. 1999,
  /// Eq. 9).
  Eigen::Vector3d force(const JointVector& torque) const noexcept;
  /// [rt] Returns 1 far from singular poses, less if a direction is damped, and 0 if the arm cannot move in this
  /// direction at all.
  double health() const noexcept { return health_; }

 private:
  TipJacobian J_;
  Eigen::Matrix3d inverse_;
  double health_ = 1;
};

}  // namespace hapticd::servo
