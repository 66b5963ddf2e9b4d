// SPDX-License-Identifier: MIT
/// The hardware behind the module: replace this file with code that talks to your hardware. Here the hardware is
/// simulated: a gantry with three motors that push one carriage along x, y and z, and a hand that holds the carriage
/// and moves it up and down.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

namespace template_arm {

using Vec3 = std::array<double, 3>;

/// The functions that a board must have. A transfer that may block (USB, serial line, network) belongs in a separate
/// thread (see io_thread.hpp). Then receive() and send() exchange the newest record with that thread, and never wait.
class Board {
 public:
  static constexpr double kEncoderStep = 1e-5;   ///< [m]
  static constexpr double kFriction = 2;         ///< [N s/m]
  static constexpr double kHandStiffness = 300;  ///< [N/m]
  static constexpr double kHandDamping = 4;      ///< [N s/m]
  static constexpr double kSubstep = 1e-4;       ///< [s]
  static constexpr int kMaxSubsteps = 10000;     ///< most substeps in one call; the rest of a longer gap is left out
  static constexpr double kTop = 0.08, kBottom = 0.04, kStroke = 2;  ///< [m], [m] range of the hand; [s] its period

  /// [main] Begins with the carriage at rest in the hand at time `now_ns`. @param gravity [m/s^2]
  void start(uint64_t now_ns, double mass, const Vec3& gravity) {
    mass_ = mass;
    gravity_ = gravity;
    start_ns_ = now_ns_ = now_ns;
    position_ = hand(0);
    velocity_ = force_ = {};
  }
  /// [rt] Returns the encoder positions [m] at time `now_ns`.
  Vec3 receive(uint64_t now_ns) noexcept {
    advance(now_ns);
    Vec3 counted;
    for (int i = 0; i < 3; ++i) counted[i] = kEncoderStep * std::round(position_[i] / kEncoderStep);
    return counted;
  }
  /// [rt] Sets the forces of the three motors in N until the next call.
  void send(const Vec3& force) noexcept { force_ = force; }

 private:
  Vec3 hand(double t) const noexcept {
    const double turn = 2 * 3.14159265358979323846 * t / kStroke;
    return {0, 0.5 * (kTop + kBottom) + 0.5 * (kTop - kBottom) * std::cos(turn), 0};
  }
  void advance(uint64_t now_ns) noexcept {
    if (now_ns <= now_ns_) return;
    const double seconds = 1e-9 * static_cast<double>(now_ns - now_ns_);
    const int steps = static_cast<int>(std::fmin(std::ceil(seconds / kSubstep), kMaxSubsteps));
    const double h = std::fmin(seconds / steps, kSubstep);
    now_ns_ = now_ns;
    const Vec3 held = hand(1e-9 * static_cast<double>(now_ns - start_ns_));
    for (int n = 0; n < steps; ++n)
      for (int i = 0; i < 3; ++i) {
        const double pull = kHandStiffness * (held[i] - position_[i]) - (kHandDamping + kFriction) * velocity_[i];
        velocity_[i] += h * ((force_[i] + pull) / mass_ + gravity_[i]);
        position_[i] += h * velocity_[i];
      }
  }

  double mass_ = 1;
  Vec3 gravity_{}, position_{}, velocity_{}, force_{};
  uint64_t start_ns_ = 0, now_ns_ = 0;
};

}  // namespace template_arm
