// SPDX-License-Identifier: MIT
/// Passivity observer and controller (Hannaford & Ryu 2002): sums the energy that goes into and out of the scene at one
/// probe, and adds damping while the sum is negative. The damping changes smoothly, so that it is never felt as a buzz.
#pragma once
#include <Eigen/Core>
#include <limits>

namespace hapticd::passivity {

/// The energy that the scene reports at one probe in each tick.
struct Exchange {
  /// [J] Work that moving models did on the probe since the last tick: their force times the motion of their surface.
  /// This energy is allowed; otherwise a model that pushes the hand would look like a wall that creates energy.
  double supplied = 0;
  /// [J] Largest energy that the contacts can still give back. A long stroke with damping puts in far more energy. If
  /// that stayed in the sum, it would hide a later vibration.
  double recoverable = std::numeric_limits<double>::infinity();
  /// True if a program's push is part of the force. The steady or slow part of a push may give energy, as a weight
  /// does; only the swinging part counts.
  bool pushed = false;
};

/// [any] Returns the largest damping [N s/m] that the controller may add to an arm of this mass [kg] without causing an
/// oscillation itself, given one or two samples of delay and its smoothing. @param period [s]
double stableDamping(double mass, double period) noexcept;

class PassivityController {
 public:
  /// [main] @param max_damping [N s/m] largest damping that it adds; stableDamping() is a good choice
  /// @param device_damping [N s/m] known damping of the device itself, which takes energy too
  /// @param resolution [m] of the measured position: energy below one step cannot be measured
  explicit PassivityController(double max_damping, double device_damping = 0, double resolution = 0)
      : max_damping_(max_damping), device_damping_(device_damping), resolution_(resolution) {}

  /// [rt] Takes the position [m] of this tick and the force [N] that the scene wants to apply until the next tick, and
  /// returns the force to apply. The energy sum uses the force that was really held in the tick that ended, times the
  /// motion in it. Without a force (free space) the credit is forgotten.
  /// @param dt [s] since the last tick
  Eigen::Vector3d update(const Eigen::Vector3d& position, const Eigen::Vector3d& force, double dt,
                         const Exchange& exchange = {}) noexcept;

  /// [rt] Called after update() with the force [N] that is left after the limits, which the hand will feel.
  void applied(const Eigen::Vector3d& force) noexcept;
  void reset() noexcept;  ///< [rt]

  double energy() const noexcept { return energy_; }  ///< [rt] [J] energy put in minus given back, since contact began
  double swing() const noexcept { return swing_; }    ///< [rt] [J] energy of the swinging parts while a program pushes
  double damping() const noexcept { return damping_; }        ///< [rt] [N s/m] present damping
  double dissipated() const noexcept { return dissipated_; }  ///< [rt] [J] energy that the controller took so far

 private:
  void follow(const Eigen::Vector3d& way, double dt) noexcept;
  Eigen::Vector3d moved(const Eigen::Vector3d& way, double dt, bool pushed) noexcept;
  void recordSwing(const Eigen::Vector3d& way, double dt, const Exchange& exchange) noexcept;
  void leaveContact(double dt) noexcept;
  void settle(const Eigen::Vector3d& force, double dt) noexcept;
  Eigen::Vector3d resistance(const Eigen::Vector3d& force) const noexcept;

  double max_damping_, device_damping_, resolution_;
  double energy_ = 0, damping_ = 0, dissipated_ = 0;
  double swing_ = 0;   ///< [J] like energy_, without the slow parts of force and motion
  double lively_ = 1;  ///< 1: the probe moves; 0: it rests, apart from encoder counts
  double share_ = 1;   ///< share of the scene's force that the limits let through in the last tick
  Eigen::Vector3d position_{0, 0, 0}, held_{0, 0, 0}, added_{0, 0, 0}, smoothed_{0, 0, 0}, velocity_{0, 0, 0};
  Eigen::Vector3d rest_{0, 0, 0};                     ///< [m] position of the probe when it last moved
  Eigen::Vector3d steady_{0, 0, 0}, drift_{0, 0, 0};  ///< [N], [m/s] slow parts of force and motion
  bool started_ = false, pushed_ = false;
};

}  // namespace hapticd::passivity
