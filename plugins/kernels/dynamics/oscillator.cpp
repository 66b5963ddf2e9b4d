// SPDX-License-Identifier: MIT
#include "kernels/dynamics/oscillator.hpp"

#include <cmath>

namespace hapticd::dynamics {
namespace {

/// Returns the step in the overdamped or critical case, with the two real rates -fast and -slow. The difference of the
/// exponentials is computed by expm1, and the slow rate from the product of both rates. So no digits cancel, even if
/// the rates are almost equal or far apart.
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

OscillatorStep oscillatorStep(double mass, double damping, double stiffness, double dt) noexcept {
  const double half = damping / (2 * mass);
  const double square = stiffness / mass;
  if (half == 0 && square == 0) return {1, dt, 0, 1};
  // half^2 - square as a product, which is exact to rounding even if both are nearly the same
  const double natural = std::sqrt(square);
  const double difference = (half - natural) * (half + natural);
  if (difference >= 0) return overdamped(half, std::sqrt(difference), square, dt);
  return underdamped(half, std::sqrt(-difference), square, dt);
}

}  // namespace hapticd::dynamics
