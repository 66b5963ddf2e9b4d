// SPDX-License-Identifier: MIT
/// How a free rigid body turns in its own frame.
#pragma once
#include <Eigen/Core>

#include "kernels/dynamics/rotation.hpp"

namespace hapticd::dynamics {

/// Euler's top, split. With the angular momentum m in the principal axes the energy is
///   |m|^2/(2 I_r) + (1/I_a - 1/I_r) m_a^2/2 + (1/I_b - 1/I_r) m_b^2/2.
/// The first part turns the body about its momentum, which is fixed in the world, and commutes with the others; each of
/// those turns it about one of its axes. Reference r is chosen so that the two disturb each other least: a body with
/// two equal moments is turned exactly, whatever the step. (Touma & Wisdom 1994; Dullweber, Leimkuhler & McLachlan
/// 1997.)
class Top {
 public:
  Top() = default;
  /// [main] @param principal moments of inertia, all above 0 [kg m^2]
  explicit Top(const Eigen::Vector3d& principal) noexcept;

  /// [rt] Turn of h [s] about the body's axes, beside that about the momentum; `momentum` in the principal axes.
  SmallTurn bodyTurn(Eigen::Vector3d momentum, double h) const noexcept;
  /// [rt] The same to second order (Strang), for a fifth of the time: where something else is no better than first.
  SmallTurn roughBodyTurn(Eigen::Vector3d momentum, double h) const noexcept;
  double worldRate() const noexcept {
    return world_rate_;
  }  ///< [rt] True if bodyTurn() is exact for every step.
  /// [rt] True if bodyTurn() is exact for every step.
  bool symmetric() const noexcept { return rate_a_ == 0 || rate_b_ == 0; }
  double bodyRate() const noexcept { return fastest_; }  ///< [rt] bound of |bodyTurn|/h over |momentum|

 private:
  int a_ = 0, b_ = 1;
  double rate_a_ = 0, rate_b_ = 0, world_rate_ = 1, fastest_ = 0;
};

}  // namespace hapticd::dynamics
