// SPDX-License-Identifier: MIT
/// The force at the tip that measured joint torques amount to.
#pragma once
#include <Eigen/Core>

#include "hapticd/device.h"

namespace hapticd::servo {

/// Its rows are the velocity of the tip in the device frame, with one column per joint.
using TipJacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, HDV_MAX_JOINTS>;
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, HDV_MAX_JOINTS, 1>;

/// J J^T of a tip, which can be inverted near singular poses too: directions in which the arm cannot move are damped
/// (Nakamura & Hanafusa 1986), so that an answer stays bounded and fades to zero along them.
class TipInverse {
 public:
  static constexpr double kDamped = 0.05;  ///< singular values below this fraction of the largest are damped

  /// [rt]
  explicit TipInverse(const TipJacobian& J) noexcept;

  /// [rt] pinv(J) v: the smallest joint rates that move the tip with v.
  JointVector rates(const Eigen::Vector3d& velocity) const noexcept;
  /// [rt] pinv(J^T) tau: the force at the tip that explains the torques best (the inverse of Thompson et al. 1999, Eq.
  /// 9).
  Eigen::Vector3d force(const JointVector& torque) const noexcept;
  /// [rt] 1: far from singular. Below 1 some direction is damped; 0: the arm cannot move along it.
  double health() const noexcept { return health_; }

 private:
  TipJacobian J_;
  Eigen::Matrix3d inverse_;
  double health_ = 1;
};

}  // namespace hapticd::servo
