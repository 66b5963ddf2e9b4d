// SPDX-License-Identifier: MIT
/// A pendulum: one angle about a fixed axis, I theta'' = -m g L sin(theta) - c theta' + torque.
#pragma once

namespace hapticd::dynamics {

struct PendulumLaw {
  double mass = 1;        ///< [kg] m
  double inertia = 1;     ///< I: moment of inertia about the pivot [kg m^2]
  double length = 1;      ///< L: distance from the pivot to the centre of mass [m]
  double damping = 0;     ///< [N m s/rad] c
  double gravity = 9.81;  ///< g: component of gravity in the plane of motion [m/s^2]

  /// Returns the square of the angular frequency of a small swing [1/s^2].
  double frequencySquared() const noexcept { return mass * gravity * length / inertia; }
};

struct PendulumState {
  double angle = 0;  ///< [rad] angle from hanging straight down
  double rate = 0;   ///< [rad/s] angular velocity
};

/// [any] Checks a law. @throws std::invalid_argument unless all numbers are finite, mass and inertia are above 0, and
/// length and damping are not below 0.
void validate(const PendulumLaw& law);

/// [rad] largest phase by which a small swing may advance in one step of advance(), so that the step is stable (test
/// Pendulum.IsStableUpToItsLargestSwing). The step is accurate up to a tenth of this.
inline constexpr double kLargestSwing = 32;

/// [main] Checks that a body that swings at `swing_rate` [rad/s] is not too fast for steps at `rate_hz`; 0 means that
/// the rate is not known yet. @throws std::invalid_argument that names the bound.
void validateSwing(double swing_rate, double rate_hz);

/// [rt] Advances by one step of dt [s]. A fast motion is divided into substeps. Without damping the method is a
/// splitting of fourth order, whose energy error stays bounded. With weak damping it is Runge-Kutta of fourth order. If
/// damping / inertia times the substep exceeds 0.05, it is an exponential step of second order, which is stable for
/// every damping (tests Pendulum.KeepsItsEnergyForMillionsOfTicks, Pendulum.ConvergesWithTheOrderItClaims).
/// @param torque [N m] torque of the user, constant in the step
PendulumState advance(const PendulumLaw& law, PendulumState state, double torque, double dt) noexcept;

/// [any] Returns kinetic plus potential energy [J]; 0 if the pendulum hangs at rest.
double energy(const PendulumLaw& law, const PendulumState& state) noexcept;

/// [any] Returns the period [s] of a free swing of `amplitude` [rad], by the arithmetic-geometric mean.
double period(const PendulumLaw& law, double amplitude) noexcept;

}  // namespace hapticd::dynamics
