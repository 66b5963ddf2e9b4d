// SPDX-License-Identifier: MIT
/// Passivity observer and controller (Hannaford & Ryu 2002): books of the energy that goes in and out of the scene at
/// one probe, and damping when they are negative. The damping is held and smooth, so that it is never felt as a buzz.
#pragma once
#include <Eigen/Core>
#include <limits>

namespace hapticd::passivity {

/// What the scene reports of its energy at one probe, in each tick.
struct Exchange {
  /// [J] Work that moving models did on the probe since the last tick: their force times the way of their surface. They
  /// may give this energy; without it a model that pushes the hand would look like a wall that makes energy.
  double supplied = 0;
  /// [J] The most that the contacts can still give back. A long stroke with damping pays in far more, which would hide
  /// a later vibration if it stayed in the book.
  double recoverable = std::numeric_limits<double>::infinity();
  /// A program's push is part of the force. The program may give its steady or slow part, as a weight does: only the
  /// part that swings is held against it.
  bool pushed = false;
};

/// [any] The most damping [N s/m] that the controller may add to an arm of this mass [kg] without being the cause of an
/// oscillation, with a sample or two of delay and its own smoothing. @param period [s]
double stableDamping(double mass, double period) noexcept;

class PassivityController {
 public:
  /// [main] @param max_damping [N s/m] the most it adds; stableDamping() is a good choice.  @param device_damping [N
  /// s/m] of the device's own that is known: it takes energy too
  /// @param resolution [m] of the measured position: energy below one step of it is not seen
  explicit PassivityController(double max_damping, double device_damping = 0, double resolution = 0)
      : max_damping_(max_damping), device_damping_(device_damping), resolution_(resolution) {}

  /// [rt] Takes the position [m] of this tick and the force [N] the scene wants to apply until the next; gives the
  /// force to apply. The book counts what the hand really felt in the tick that ended: the force that was held then,
  /// times the way gone. In free space (no force) the credit is forgotten.
  /// @param dt [s] since the last tick
  Eigen::Vector3d update(const Eigen::Vector3d& position, const Eigen::Vector3d& force, double dt,
                         const Exchange& exchange = {}) noexcept;

  /// [rt] Call it after update(): the force [N] that the limits left of it, which the hand will have felt.
  void applied(const Eigen::Vector3d& force) noexcept;
  void reset() noexcept;  ///< [rt]

  double energy() const noexcept { return energy_; }          ///< [rt] [J] put in minus given back, since contact began
  double swing() const noexcept { return swing_; }            ///< [rt] [J] the same for what swings under a push alone
  double damping() const noexcept { return damping_; }        ///< [rt] [N s/m] that it is ready to add
  double dissipated() const noexcept { return dissipated_; }  ///< [rt] [J] taken by the controller so far

 private:
  void follow(const Eigen::Vector3d& way, double dt) noexcept;
  Eigen::Vector3d moved(const Eigen::Vector3d& way, double dt, bool pushed) noexcept;
  void bookSwing(const Eigen::Vector3d& way, double dt, const Exchange& exchange) noexcept;
  void leaveContact(double dt) noexcept;
  void settle(const Eigen::Vector3d& force, double dt) noexcept;
  Eigen::Vector3d resistance(const Eigen::Vector3d& force) const noexcept;

  double max_damping_, device_damping_, resolution_;
  double energy_ = 0, damping_ = 0, dissipated_ = 0;
  double swing_ = 0;   ///< [J] as energy_, without the slow part of force and motion
  double lively_ = 1;  ///< 1: the probe moves; 0: it rests but for counts of the encoder
  double share_ = 1;   ///< of the scene's force, as the limits let it through in the last tick
  Eigen::Vector3d position_{0, 0, 0}, held_{0, 0, 0}, added_{0, 0, 0}, smoothed_{0, 0, 0}, velocity_{0, 0, 0};
  Eigen::Vector3d rest_{0, 0, 0};                     ///< [m] where the probe was when it last moved
  Eigen::Vector3d steady_{0, 0, 0}, drift_{0, 0, 0};  ///< [N], [m/s] slow parts of force and motion
  bool started_ = false, pushed_ = false;
};

}  // namespace hapticd::passivity
