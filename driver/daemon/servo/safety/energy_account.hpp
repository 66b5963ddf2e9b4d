// SPDX-License-Identifier: MIT
/// Sums the energy that one model gives to one probe. A surface that rests in the frame of its model gives back at
/// most what was put in. So the sum of a good surface is never much above zero, whatever the hand does. What has no
/// surface (a field), is soft, jumps on purpose or is set by a program may give more, but not for ever.
#pragma once
#include <Eigen/Core>

#include "hapticd/abi.h"

namespace hapticd::servo {

/// The push of a model on a probe in one step, in the frame of the model.
struct Push {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< [N]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m] of the probe
  double depth = 0;                                    ///< [m] of the probe; 0 outside
  bool surface = false;                                ///< a surface pushes that claims to rest
};

class EnergyAccount {
 public:
  /// [J] A surface may give so much at once, and kMostPower [W] for as long as it likes: bumps that push the hand
  /// without a force along them, and sudden changes of the foot at a fast hand, give up to 30 mJ.
  static constexpr double kMostGiven = 0.2;
  static constexpr double kMostPower = 0.3;
  /// [m], [m/s] Every model may give the work of the arm's whole force over this distance at once, as a magnet that
  /// draws the hand across the room of the arm does, and over this speed for as long as it likes, as one that leads the
  /// hand does.
  static constexpr double kDistance = 0.5;
  static constexpr double kSpeed = 0.2;

  /// [rt] Adds the work of the push of this step since that of the last one. The mean of both forces is used: so a
  /// spring gives nothing, although it is sampled.
  /// @param dt [s] since the last step
  /// @param reported [J] that the shape says it stores; it may give back no more of it than it got
  /// @param most_force [N] that the arm lets through; 0: unknown
  /// @return true if the model has given too much
  bool step(const Push& push, double dt, double reported = 0, double most_force = 0) noexcept HSP_RT;
  /// [rt] Forgets the last push, but not what was given: the probe jumped, or its sample was bad.
  void forgetPush() noexcept HSP_RT { known_ = false; }
  /// [rt] Called when somebody has set a parameter of the model.
  void noteChange() noexcept HSP_RT { changed_ = true; }

  double given() const noexcept { return given_; }  ///< [J] energy that the surface gave; < 0: it may give so much back
  /// [J] the same of all pushes
  double givenByAll() const noexcept { return given_by_all_; }

 private:
  double given_ = 0, given_by_all_ = 0;
  Push last_;               // of the last step
  double last_stored_ = 0;  // [J] that it could give back at most
  bool met_ = false;        // last_ is the push of some step before
  bool known_ = false;      // last_ is the push of the last step
  bool changed_ = false;    // a parameter was set since the last step
};

}  // namespace hapticd::servo
