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
  /// [J] Largest energy that the contacts can still give back. A long motion against damping puts far more energy into
  /// the sum. If this energy stayed there, it would hide a vibration that comes later. So the sum is reduced to this
  /// value.
  double recoverable = std::numeric_limits<double>::infinity();
  /// True if a program's push is part of the force. The steady or slow part of a push may give energy to the hand, as a
  /// weight does. Only the oscillating part counts as energy that the loop creates.
  bool pushed = false;
};

/// [any] Returns the largest damping [N s/m] that the controller may add to an arm of this mass [kg] without causing an
/// oscillation itself. The value allows for one or two samples of delay in the loop, and for the smoothing of the
/// velocity.
/// @param period [s] of the servo
double stableDamping(double mass, double period) noexcept;

class PassivityController {
 public:
  /// [main] @param max_damping [N s/m] largest damping that the controller adds; stableDamping() is a good choice
  /// @param device_damping [N s/m] known damping of the device itself, which takes energy too
  /// @param resolution [m] of the measured position: the energy of less than one such step cannot be measured
  explicit PassivityController(double max_damping, double device_damping = 0, double resolution = 0)
      : max_damping_(max_damping), device_damping_(device_damping), resolution_(resolution) {}

  /// [rt] Takes the position [m] of this tick and the force [N] that the scene wants to apply until the next tick, and
  /// returns the force to apply. The energy sum is calculated from the motion since the last tick, and from the force
  /// that the motors really gave in this time. Without a force (in free space), a positive energy sum is forgotten.
  /// @param dt [s] since the last tick
  Eigen::Vector3d update(const Eigen::Vector3d& position, const Eigen::Vector3d& force, double dt,
                         const Exchange& exchange = {}) noexcept;

  /// [rt] Call it after update(), with the force [N] that the limits left, which is the force that the hand will feel.
  void applied(const Eigen::Vector3d& force) noexcept;
  void reset() noexcept;  ///< [rt]

  double energy() const noexcept { return energy_; }  ///< [rt] [J] energy put in minus given back, since contact began
  /// [rt] [J] energy of the oscillating parts of force and motion, while a program pushes
  double swing() const noexcept { return swing_; }
  double damping() const noexcept { return damping_; }        ///< [rt] [N s/m] present damping
  double dissipated() const noexcept { return dissipated_; }  ///< [rt] [J] energy that the controller took so far

 private:
  void follow(const Eigen::Vector3d& motion, double dt) noexcept;
  Eigen::Vector3d moved(const Eigen::Vector3d& motion, double dt, bool pushed) noexcept;
  void recordSwing(const Eigen::Vector3d& motion, double dt, const Exchange& exchange) noexcept;
  void leaveContact(double dt) noexcept;
  void settle(const Eigen::Vector3d& force, double dt) noexcept;
  Eigen::Vector3d resistance(const Eigen::Vector3d& force) const noexcept;

  double max_damping_, device_damping_, resolution_;
  double energy_ = 0, damping_ = 0, dissipated_ = 0;
  double swing_ = 0;   ///< [J] like energy_, without the slow parts of force and motion
  double lively_ = 1;  ///< 1: the probe moves; 0: it moves by no more than a few encoder steps
  double share_ = 1;   ///< share of the scene's force that the limits let through in the last tick
  Eigen::Vector3d position_{0, 0, 0}, held_{0, 0, 0}, added_{0, 0, 0}, smoothed_{0, 0, 0}, velocity_{0, 0, 0};
  Eigen::Vector3d rest_{0, 0, 0};                     ///< [m] position of the probe when it last moved
  Eigen::Vector3d steady_{0, 0, 0}, drift_{0, 0, 0};  ///< [N], [m/s] slow parts of force and motion
  bool started_ = false, pushed_ = false;
};

}  // namespace hapticd::passivity
