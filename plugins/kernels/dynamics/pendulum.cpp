// SPDX-License-Identifier: MIT
#include "kernels/dynamics/pendulum.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "kernels/dynamics/splitting.hpp"

namespace hapticd::dynamics {
namespace {

constexpr double kLargestPhase = 0.1;         // [rad] phase of the linear swing per substep of freeStep()
constexpr double kLargestDampedPhase = 0.02;  // [rad] the same phase for the two methods with damping
constexpr int kPendulumSubsteps = 32;         // most substeps per step, which bounds the time of a tick
// damping/inertia times the substep up to which Runge-Kutta resolves the decay
constexpr double kWeak = 0.05;

/// Makes a step without damping. The error of its energy stays bounded for ever.
PendulumState freeStep(double w2, double drive, PendulumState s, double h) noexcept {
  Splitting::step(
      h, [&](double time) { s.angle += time * s.rate; },
      [&](double time) { s.rate += time * (drive - w2 * std::sin(s.angle)); });
  return s;
}

/// Makes a step with weak damping, by the classical Runge-Kutta method of fourth order.
PendulumState rungeKutta(double w2, double c, double drive, PendulumState s, double h) noexcept {
  const auto acceleration = [&](double angle, double rate) { return drive - w2 * std::sin(angle) - c * rate; };
  const double v1 = s.rate, a1 = acceleration(s.angle, v1);
  const double v2 = s.rate + h / 2 * a1, a2 = acceleration(s.angle + h / 2 * v1, v2);
  const double v3 = s.rate + h / 2 * a2, a3 = acceleration(s.angle + h / 2 * v2, v3);
  const double v4 = s.rate + h * a3, a4 = acceleration(s.angle + h * v3, v4);
  return {s.angle + h / 6 * (v1 + 2 * v2 + 2 * v3 + v4), s.rate + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4)};
}

/// Makes a step with strong damping. It solves v' = a - c v exactly, with `a` from the angle in the middle of the step,
/// so it is stable for every damping.
PendulumState exponential(double w2, double c, double drive, PendulumState s, double h) noexcept {
  const double decay = std::exp(-c * h), phi = -std::expm1(-c * h) / c;
  const double half_phi = -std::expm1(-c * h / 2) / c;
  const double half_drift = (h / 2 - half_phi) / c, drift = (h - phi) / c;
  const double middle = s.angle + half_phi * s.rate + half_drift * (drive - w2 * std::sin(s.angle));
  const double a = drive - w2 * std::sin(middle);
  return {s.angle + phi * s.rate + drift * a, decay * s.rate + phi * a};
}

PendulumState substep(double w2, double c, double drive, PendulumState s, double h) noexcept {
  if (c == 0) return freeStep(w2, drive, s, h);
  return c * h <= kWeak ? rungeKutta(w2, c, drive, s, h) : exponential(w2, c, drive, s, h);
}

}  // namespace

void validate(const PendulumLaw& law) {
  const bool finite = std::isfinite(law.mass) && std::isfinite(law.inertia) && std::isfinite(law.length) &&
                      std::isfinite(law.damping) && std::isfinite(law.gravity);
  if (!finite || !(law.mass > 0) || !(law.inertia > 0) || law.length < 0 || law.damping < 0)
    throw std::invalid_argument(
        "pendulum: mass and inertia must be above 0, length and damping must not be below 0, and all must be finite");
}

void validateSwing(double swing_rate, double rate_hz) {
  if (!(rate_hz > 0) || swing_rate <= kLargestSwing * rate_hz) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "it swings at %.4g rad/s, but its motion is stable up to at most %.4g rad/s at %.4g Hz; give it more "
                "inertia or a weaker pull, or set servo.rate to %.0f Hz",
                swing_rate, kLargestSwing * rate_hz, rate_hz, std::ceil(swing_rate / kLargestSwing));
  throw std::invalid_argument(text);
}

PendulumState advance(const PendulumLaw& law, PendulumState state, double torque, double dt) noexcept {
  if (!(dt > 0) || !std::isfinite(dt) || !std::isfinite(torque)) return state;
  const double w2 = law.frequencySquared();
  const double drive = torque / law.inertia;
  // the rate at the bottom is the same during the whole swing. So all substeps are equal, which a bounded energy needs
  const double lift = std::sin(state.angle / 2);
  const double fastest = std::sqrt(std::max(w2, state.rate * state.rate + 4 * w2 * lift * lift));
  const double largest = law.damping == 0 ? kLargestPhase : kLargestDampedPhase;
  const int steps =
      std::clamp(static_cast<int>(std::ceil(std::min(fastest * dt / largest, 1e6))), 1, kPendulumSubsteps);
  const double h = dt / steps;
  for (int i = 0; i < steps; ++i) state = substep(w2, law.damping / law.inertia, drive, state, h);
  return state;
}

double energy(const PendulumLaw& law, const PendulumState& state) noexcept {
  const double half = std::sin(state.angle / 2);
  return 0.5 * law.inertia * state.rate * state.rate + 2 * law.mass * law.gravity * law.length * half * half;
}

double period(const PendulumLaw& law, double amplitude) noexcept {
  double a = 1, b = std::fabs(std::cos(amplitude / 2));
  constexpr int kRounds = 40;  // it converges quadratically; only amplitudes near pi need many rounds
  for (int i = 0; i < kRounds && std::fabs(a - b) > 1e-16 * a; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * M_PI / (a * std::sqrt(law.frequencySquared()));
}

}  // namespace hapticd::dynamics
