// SPDX-License-Identifier: MIT
/// A torsion spring on a pendulum: I theta'' = -m g L sin(theta) - c theta' - k (theta - rest) + torque.
#pragma once
#include "kernels/dynamics/pendulum.hpp"

namespace hapticd::dynamics {

struct TorsionSpring {
  double stiffness = 0;  ///< [N m/rad] k, above 0 if there is a spring
  double rest = 0;       ///< [rad] angle at which the spring is relaxed, counted as the pendulum's angle
};

/// [rt] Advances a pendulum with a spring (k > 0) by one step of dt [s]. Spring and damping are stepped exactly
/// (oscillator.hpp), and so is the weight near the rest of the spring. What is left of the weight acts before and after
/// (Strang splitting, second order). So without weight the
/// motion is exact, and it stays bounded for every spring, inertia and rate. With weight it is divided into substeps,
/// and stays bounded while w dt <= kLargestSwing, with w^2 = (m g L + k)/I (test
/// TorsionSpring.StaysBoundedWithAWeight).
/// @param torque [N m] torque of the user, constant in the step
PendulumState advance(const PendulumLaw& law, const TorsionSpring& spring, PendulumState state, double torque,
                      double dt) noexcept;

}  // namespace hapticd::dynamics
