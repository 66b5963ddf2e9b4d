// SPDX-License-Identifier: MIT
/// A pendulum: one angle about a fixed axis, I theta'' = -m g L sin(theta) - c theta' + torque.
#pragma once

namespace hapticd::dynamics {

struct PendulumLaw {
  double mass = 1;        ///< [kg]
  double inertia = 1;     ///< about the pivot [kg m^2]
  double length = 1;      ///< pivot to centre of mass [m]
  double damping = 0;     ///< [N m s/rad]
  double gravity = 9.81;  ///< part of gravity that acts in the plane of motion [m/s^2]

  double frequencySquared() const noexcept { return mass * gravity * length / inertia; }  ///< [1/s^2]
};

struct PendulumState {
  double angle = 0;  ///< [rad] from hanging down
  double rate = 0;   ///< [rad/s]
};

/// [any] @throws std::invalid_argument unless all is finite, mass and inertia above 0, length and damping not below 0.
void validate(const PendulumLaw& law);

/// [rad] of the linear swing in one step, up to which advance() is stable (test Pendulum.IsStableUpToItsLargestSwing);
/// accurate it is up to a tenth of that.
inline constexpr double kLargestSwing = 32;

/// [main] @throws std::invalid_argument with the bound if something that swings at `swing_rate` [rad/s] is too fast for
/// steps at `rate_hz`; a rate of 0 is not known yet.
void validateSwing(double swing_rate, double rate_hz);

/// [rt] One step of dt [s] with a constant torque of the user [N m], split where the motion is faster than the step.
/// Without damping a splitting of fourth order, whose energy stays; with weak damping Runge-Kutta of fourth order;
/// where damping/inertia times the substep exceeds 0.05 an exponential step of second order, stable however strong the
/// damping (tests Pendulum.KeepsItsEnergyForTenMillionTicks, Pendulum.ConvergesWithTheOrderItClaims).
PendulumState advance(const PendulumLaw& law, PendulumState state, double torque, double dt) noexcept;

/// [any] Kinetic and potential energy [J], zero hanging at rest.
double energy(const PendulumLaw& law, const PendulumState& state) noexcept;

/// [any] Period [s] of free swinging from rest at `amplitude` [rad], by the arithmetic-geometric mean.
double period(const PendulumLaw& law, double amplitude) noexcept;

/// [any] Rate at the bottom [rad/s] above which it goes all the way round.
double separatrixRate(const PendulumLaw& law) noexcept;

}  // namespace hapticd::dynamics
