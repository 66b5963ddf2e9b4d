// SPDX-License-Identifier: MIT
/// Keeps a contact passive over short times, whatever its force depends on: a passivity observer and controller
/// (Hannaford and Ryu 2002) that knows the energy of the springs, and forgives slowly.
#pragma once
#include <algorithm>

namespace hapticd::medial {

/// What hands have put into the springs of a contact and not got back. A straight press puts in exactly the energy of
/// the springs. A hand that comes from beside may put in less, where the springs are stiffer than where it pressed:
/// then they push only with the share that was put in, and this share grows until they push wholly. So a hand that
/// swings gets back no more than it gave, and one that rests feels the stiffness of its place.
class EnergyAccount {
 public:
  /// [s] time within which most of what is missing is forgiven. A contact that buzzes swings much faster; a hand that
  /// strokes over a hard place takes about so long.
  static constexpr double kForgivesIn = 0.5;

  /// [rt] Adds work [J] that hands did; negative if they got it.
  void add(double work) noexcept { held_ += work; }
  /// [rt] Forgets what is more than `energy` [J]: the rest was lost in dampers.
  void keep(double energy) noexcept { held_ = held_ > 0 ? std::min(held_, energy) : 0; }
  /// [rt] Returns the share of the springs' force that may be exerted now, 0 to 1, and adds the work against it.
  /// @param work [J] that hands do against the whole force  @param energy [J] stored in the springs at the whole force
  /// @param dt [s] since the last tick
  double share(double work, double energy, double dt) noexcept {
    const double owed = (1 - kSlack) * energy;
    if (held_ + work < owed) held_ += dt / (kForgivesIn + dt) * (energy - held_ - work);
    if (held_ + work >= owed) {
      held_ += work;
      return 1;
    }
    const double share = held_ > 0 ? held_ / (owed - work) : 0;  // so that share * owed is what is held
    held_ = share * owed;
    return share;
  }
  double held() const noexcept { return held_; }  ///< [J]

 private:
  /// The whole force is exerted while no more than this share of its energy is missing. The force then falls faster
  /// than the energy on the way out, so that no more is given than is held, and grows back on the way in. So a contact
  /// soon forgets a step that it met near the surface. With 1/3 the force changes at most twice as fast as that of the
  /// springs.
  static constexpr double kSlack = 1.0 / 3;

  double held_ = 0;
};

}  // namespace hapticd::medial
