/// Passivity observer and controller (Hannaford & Ryu 2002): books of the energy that goes in and out of the scene at
/// one probe, and damping while they are negative.
#pragma once
#include <Eigen/Core>

namespace hapticd::passivity {

class PassivityController {
 public:
  /// [main] @param max_damping [N s/m] the most it adds; the device's mass over twice the period is a good choice, for
  /// more would itself oscillate.
  explicit PassivityController(double max_damping) : max_damping_(max_damping) {}

  /// [rt] Takes the position [m] of this tick and the force [N] the scene wants to apply until the next; gives the
  /// force to apply. The book counts what the hand really felt in the tick that ended: the force that was held then,
  /// times the way gone. In free space (no force) the book is closed.
  /// @param dt [s] since the last tick  @param supplied [J] that the scene may rightly give (a model that moves itself)
  Eigen::Vector3d update(const Eigen::Vector3d& position, const Eigen::Vector3d& force, double dt,
                         double supplied = 0) noexcept;
  void reset() noexcept;  ///< [rt]

  double energy() const noexcept { return energy_; }          ///< [rt] [J] put in minus given back, since contact began
  double damping() const noexcept { return damping_; }        ///< [rt] [N s/m] added in this tick
  double dissipated() const noexcept { return dissipated_; }  ///< [rt] [J] taken by the controller, ever

 private:
  double max_damping_;
  double energy_ = 0, damping_ = 0, dissipated_ = 0;
  Eigen::Vector3d position_{0, 0, 0}, held_{0, 0, 0}, added_{0, 0, 0};
  bool started_ = false;
};

}  // namespace hapticd::passivity
