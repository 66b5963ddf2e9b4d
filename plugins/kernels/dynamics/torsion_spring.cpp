// SPDX-License-Identifier: MIT
#include "kernels/dynamics/torsion_spring.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/dynamics/oscillator.hpp"

namespace hapticd::dynamics {
namespace {

// [rad] Phase per substep of the swing under the weight: the energy then oscillates by its square / 12, or 3e-5.
constexpr double kLargestWeightPhase = 0.02;
// [rad] Phase per substep of the swing on the spring. Kicks once per half turn of the phase would resonate with it.
constexpr double kLargestSpringPhase = 1;
constexpr int kSpringSubsteps = 32;  // most substeps per step, which bounds the time of a tick

/// Returns the number of substeps of a step. All are equal, which a bounded energy needs.
int substepsFor(double weight_square, double spring_square, double dt) noexcept {
  if (weight_square == 0) return 1;  // the step is exact
  const double phase =
      std::max(std::sqrt(weight_square) / kLargestWeightPhase, std::sqrt(spring_square) / kLargestSpringPhase) * dt;
  return 1 + static_cast<int>(std::min(phase, kSpringSubsteps - 1.0));
}

/// The weight, divided into what acts as a spring about its rest, and what is left. A stiff spring keeps the body near
/// its rest, so almost nothing is left.
struct Weight {
  double square;  ///< [1/s^2] w^2 of the weight alone
  double rest, sine, slope;

  Weight(double weight_square, double spring_rest) noexcept
      : square(weight_square),
        rest(spring_rest),
        sine(weight_square > 0 ? std::sin(spring_rest) : 0),
        slope(weight_square > 0 ? std::max(0.0, std::cos(spring_rest)) : 0) {}
  /// Returns the acceleration [rad/s^2] that is left at an angle.
  double left(double angle) const noexcept {
    return square > 0 ? -square * (std::sin(angle) - sine - slope * (angle - rest)) : 0;
  }
};

}  // namespace

PendulumState advance(const PendulumLaw& law, const TorsionSpring& spring, PendulumState state, double torque,
                      double dt) noexcept {
  if (!(dt > 0) || !std::isfinite(dt) || !std::isfinite(torque)) return state;
  const Weight weight(law.frequencySquared(), spring.rest);
  const double stiffness = spring.stiffness + law.inertia * weight.square * weight.slope;
  const int steps = substepsFor(weight.square, stiffness / law.inertia, dt);
  const double h = dt / steps;
  const OscillatorStep exact = oscillatorStep(law.inertia, law.damping, stiffness, h);
  const double balance = spring.rest + (torque - law.inertia * weight.square * weight.sine) / stiffness;
  for (int i = 0; i < steps; ++i) {
    state.rate += h / 2 * weight.left(state.angle);
    double from_balance = state.angle - balance;
    advance(exact, from_balance, state.rate);
    state.angle = balance + from_balance;
    state.rate += h / 2 * weight.left(state.angle);
  }
  return state;
}

}  // namespace hapticd::dynamics
