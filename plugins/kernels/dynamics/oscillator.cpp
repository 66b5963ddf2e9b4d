// SPDX-License-Identifier: MIT
#include "kernels/dynamics/oscillator.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace hapticd::dynamics {
namespace {

/// Overdamped or critical: the two real rates -fast and -slow. Their difference is taken by expm1 and the slow one from
/// the product of both, so that nothing cancels however far apart or near they are.
OscillatorStep overdamped(double half, double root, double square, double dt) {
  const double fast = half + root;
  const double slow = square / fast;
  const double decay = std::exp(-slow * dt);
  const double gap = fast - slow;
  // (e^(-slow t) - e^(-fast t)) / (fast - slow)
  const double sine = gap * dt < 1e-8 ? decay * dt : -decay * std::expm1(-gap * dt) / gap;
  return {decay + slow * sine, sine, -square * sine, decay - fast * sine};
}

OscillatorStep underdamped(double half, double rate, double square, double dt) {
  const double decay = std::exp(-half * dt);
  const double sine = rate * dt < 1e-8 ? dt : std::sin(rate * dt) / rate;
  const double cosine = std::cos(rate * dt);
  return {decay * (cosine + half * sine), decay * sine, -square * decay * sine, decay * (cosine - half * sine)};
}

}  // namespace

OscillatorStep oscillatorStepUnchecked(double mass, double damping, double stiffness, double dt) noexcept {
  const double half = damping / (2 * mass);
  const double square = stiffness / mass;
  if (half == 0 && square == 0) return {1, dt, 0, 1};
  // half^2 - square, as a product: exact to rounding where both are nearly the same
  const double natural = std::sqrt(square);
  const double difference = (half - natural) * (half + natural);
  if (difference >= 0) return overdamped(half, std::sqrt(difference), square, dt);
  return underdamped(half, std::sqrt(-difference), square, dt);
}

OscillatorStep oscillatorStep(double mass, double damping, double stiffness, double dt) {
  const bool good = std::isfinite(mass) && mass > 0 && std::isfinite(damping) && damping >= 0 &&
                    std::isfinite(stiffness) && stiffness >= 0 && std::isfinite(dt) && dt >= 0;
  if (!good)
    throw std::invalid_argument("oscillator: mass " + std::to_string(mass) + " kg, damping " + std::to_string(damping) +
                                " N s/m, stiffness " + std::to_string(stiffness) + " N/m, step " + std::to_string(dt) +
                                " s; expected mass > 0 and the others finite and not negative");
  return oscillatorStepUnchecked(mass, damping, stiffness, dt);
}

}  // namespace hapticd::dynamics
