// SPDX-License-Identifier: MIT
/// The smooth motion of a kinematic model to a pose that a user asked for, with the velocities that contacts need.
#pragma once
#include <Eigen/Geometry>

#include "hapticd/shape.h"

namespace hapticd::servo {

class MinimumJerk {
 public:
  static constexpr double kMoveSpeed = 0.2;  ///< [m/s] highest speed if no duration is given
  static constexpr double kShortest = 0.5;   ///< [s] shortest duration of such a move
  static constexpr double kMostSpeed = 1.0;  ///< [m/s] highest speed of any move, because the model may hit a hand
  /// [rad/s] highest angular velocity; a surface 0.3 m from the model's origin then stays below kMostSpeed
  static constexpr double kMostTurn = 3.141593;
  static constexpr double kPeakOfMean = 1.875;  ///< peak over mean speed of a minimum-jerk path

  bool active() const noexcept { return active_; }
  double seconds() const noexcept { return seconds_; }  ///< duration of the move

  /// [rt] Starts a move from `pose` at t [s]. @param seconds shortest duration, 0: by kMoveSpeed; the move takes longer
  /// if it would otherwise be faster than kMostSpeed or kMostTurn @param to_orientation w,x,y,z, a unit quaternion;
  /// zeros: keep the orientation
  void begin(double t, double seconds, const hsp_pose& pose, const double* to_position,
             const double* to_orientation) noexcept HSP_RT;

  /// [rt] Fills in pose and velocities at t, on the minimum-jerk path, which is at rest at both ends.
  void at(double t, hsp_pose& pose) const noexcept HSP_RT;

 private:
  bool active_ = false;
  double begin_ = 0, seconds_ = 1;
  Eigen::Vector3d from_ = Eigen::Vector3d::Zero(), to_ = Eigen::Vector3d::Zero(), turn_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_from_ = Eigen::Quaterniond::Identity(), q_to_ = Eigen::Quaterniond::Identity();
};

}  // namespace hapticd::servo
