// SPDX-License-Identifier: MIT
/// The rotation of a rigid body without torque (Euler's top).
#pragma once
#include <Eigen/Core>

#include "kernels/dynamics/rotation.hpp"

namespace hapticd::dynamics {

/// Euler's top, as a splitting of its energy. With the angular momentum m in the principal axes the energy is
///   |m|^2/(2 I_r) + (1/I_a - 1/I_r) m_a^2/2 + (1/I_b - 1/I_r) m_b^2/2.
/// The first part turns the body about its angular momentum, which is fixed in the world. This turn commutes with the
/// turns of the other parts. Each of the other two parts turns the body about one of its principal axes. The reference
/// axis r is chosen so that these two turns disturb each other least. The result is exact for every step if two moments
/// are equal. (Touma & Wisdom 1994; Dullweber, Leimkuhler & McLachlan 1997.)
class Top {
 public:
  Top() = default;
  /// [main] @param principal principal moments of inertia, all above 0 [kg m^2]
  explicit Top(const Eigen::Vector3d& principal) noexcept;

  /// [rt] Returns the turn in h [s] about the body's axes, without the turn about the momentum.
  /// @param momentum angular momentum in the principal axes [kg m^2/s]
  SmallTurn bodyTurn(Eigen::Vector3d momentum, double h) const noexcept;
  /// [rt] Returns the same turn as bodyTurn(), but only to second order (Strang). It takes a fifth of the time, and is
  /// accurate enough in a step whose other parts are of first order only.
  SmallTurn roughBodyTurn(Eigen::Vector3d momentum, double h) const noexcept;
  double worldRate() const noexcept {
    return world_rate_;
  }  ///< [rt] [1/(kg m^2)] rate of the turn about the momentum, divided by the momentum
  /// [rt] True if bodyTurn() is exact for every step.
  bool symmetric() const noexcept { return rate_a_ == 0 || rate_b_ == 0; }
  /// [rt] [1/(kg m^2)] upper bound of |bodyTurn| / (h |momentum|)
  double bodyRate() const noexcept { return fastest_; }

 private:
  int a_ = 0, b_ = 1;
  double rate_a_ = 0, rate_b_ = 0, world_rate_ = 1, fastest_ = 0;
};

}  // namespace hapticd::dynamics
