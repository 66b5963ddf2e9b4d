// SPDX-License-Identifier: MIT
/// Sums the energy that one model gives to the probes. A surface that rests in the frame of its model gives back at
/// most what was put in. So the sum of a good surface is never much above zero, whatever the hand does. What has no
/// surface (a field), is soft, jumps on purpose or is set by a program may give more, but not for ever.
#pragma once
#include <Eigen/Core>

#include "hapticd/abi.h"

namespace hapticd::servo {

/// The push of a model on one probe in one step, in the frame of the model.
struct Push {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< [N]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m] of the probe
  double depth = 0;                                    ///< [m] of the probe; 0 outside
  bool surface = false;                                ///< a surface pushes that claims to rest
};

/// The push of the last step.
struct LastPush {
  Push push;
  double stored = 0;   ///< [J] that it could give back at most
  bool known = false;  ///< false: the probe jumped, or its sample was bad
  bool asked = false;  ///< somebody has set a parameter of the model since
};

class EnergyAccount {
 public:
  /// [J] A surface may give so much at once, and kMostPower [W] for as long as it likes: bumps that push the hand
  /// without a force along them, and sudden changes of the foot at a fast hand, give up to 30 mJ.
  static constexpr double kMostGiven = 0.2;
  static constexpr double kMostPower = 0.3;
  /// [m], [m/s] Every model may give the work of the arm's whole force over this way at once, as a magnet that draws
  /// the hand across the room of the arm does, and over this speed for as long as it likes, as one that leads the hand
  /// does.
  static constexpr double kWay = 0.5;
  static constexpr double kSpeed = 0.2;

  /// [rt] Adds the work of one push since the last step. The mean of both forces is used: so a spring gives nothing,
  /// although it is sampled.
  void add(const Push& push, LastPush& last) noexcept HSP_RT;

  /// [rt] Call it after add() for all probes. @param dt [s] since the last step
  /// @param reported [J] that the shape says it stores; it may give back no more of it than it got
  /// @param most_force [N] that an arm lets through; 0: unknown
  /// @return true if the model has given too much
  bool closeStep(double dt, double reported = 0, double most_force = 0) noexcept HSP_RT;

  double given() const noexcept { return given_; }  ///< [J] energy that the surface gave; < 0: it may give so much back
  /// [J] the same of all pushes
  double givenByAll() const noexcept { return given_by_all_; }

 private:
  double given_ = 0, given_by_all_ = 0;
  double stored_ = 0;  // [J] that the pushes of this step can give back at most
};

}  // namespace hapticd::servo
