// SPDX-License-Identifier: MIT
/// A kinematic model on its way to where a person asked it to go: smooth, and with the velocities that contacts need.
#pragma once
#include <Eigen/Geometry>

#include "hapticd/shape.h"

namespace hapticd::servo {

class MinimumJerk {
 public:
  static constexpr double kMoveSpeed = 0.2;      ///< [m/s] speed if nobody says how long a move takes
  static constexpr double kShortest = 0.5;       ///< [s] shortest time of such a move
  static constexpr double kMostSpeed = 1.0;      ///< [m/s] of a moved model, because a hand may be behind it
  static constexpr double kMostTurn = 3.141593;  ///< [rad/s] at which a surface 0.3 m from its origin keeps to that too
  static constexpr double kPeakOfMean = 1.875;   ///< speed of a path of least jerk

  bool active() const noexcept { return active_; }
  double seconds() const noexcept { return seconds_; }  ///< that it takes

  /// [rt] From `pose` to another, beginning at t [s]. @param seconds at least; longer where it would be faster than
  /// kMostSpeed or kMostTurn; 0: about kMoveSpeed @param to_orientation w,x,y,z, a unit quaternion; zeros: it stays as
  /// it is
  void begin(double t, double seconds, const hsp_pose& pose, const double* to_position,
             const double* to_orientation) noexcept HSP_RT;

  /// [rt] Pose and velocities at t: the path of least jerk, at rest at both ends.
  void at(double t, hsp_pose& pose) const noexcept HSP_RT;

 private:
  bool active_ = false;
  double begin_ = 0, seconds_ = 1;
  Eigen::Vector3d from_ = Eigen::Vector3d::Zero(), to_ = Eigen::Vector3d::Zero(), turn_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_from_ = Eigen::Quaterniond::Identity(), q_to_ = Eigen::Quaterniond::Identity();
};

}  // namespace hapticd::servo
