// SPDX-License-Identifier: MIT
/// Sums the energy that the surface of one model gives to the probes. A surface that rests in the frame of its model
/// gives back at most what was put in. So the sum of a good shape is never much above zero, whatever the hand does.
#pragma once
#include <Eigen/Core>

#include "hapticd/abi.h"

namespace hapticd::servo {

/// The push of a model on one probe in the last step, in the frame of the model.
struct LastPush {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< [N]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m] of the probe
  double stored = 0;                                   ///< [J] that it could give back at most
  bool known = false;  ///< false: the probe jumped, its sample was bad, or somebody changed the model
};

class EnergyAccount {
 public:
  /// [J] A surface may give so much at once, and kMostPower [W] for as long as it likes: bumps that push the hand
  /// without a force along them, and sudden changes of the foot at a fast hand, give up to 30 mJ.
  static constexpr double kMostGiven = 0.2;
  static constexpr double kMostPower = 0.3;

  /// [rt] Adds the work of one push since the last step. The mean of both forces is used: so a spring gives nothing,
  /// although it is sampled. @param depth [m] depth of the probe, <= 0 outside
  void add(const Eigen::Vector3d& force, const Eigen::Vector3d& position, double depth, LastPush& last) noexcept HSP_RT;

  /// [rt] Call it after add() for all probes. @param dt [s] since the last step
  /// @param reported [J] that the shape says it stores; it may give back no more of it than it got
  /// @return true if the surface has given too much
  bool closeStep(double dt, double reported = 0) noexcept HSP_RT;

  double given() const noexcept { return given_; }  ///< [J] energy given; < 0: it may give so much back

 private:
  double given_ = 0;
  double stored_ = 0;  // [J] that the pushes of this step can give back at most
};

}  // namespace hapticd::servo
