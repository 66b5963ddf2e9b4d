// SPDX-License-Identifier: MIT
/// The simulated hand: a mass on a spring and damper whose other end follows a script, with a seeded tremor. This
/// target and the force of the tremor depend only on time, so a run does not depend on the size of the steps. The
/// exception is the guided hand, whose target comes from a program.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "simulated/hand_path.hpp"

namespace hapticd::simulated {

enum class Script { kHold, kStroke, kPress, kTap, kCircle, kPath, kNone, kGuided };

/// The settings of the hand, as the parameters hand.* give them. Positions are in the device frame.
struct HandSettings {
  Script script = Script::kStroke;
  double mass = 0.2, stiffness = 500, damping = 5;    ///< [kg], [N/m], [N s/m]
  Eigen::Vector3d center = Eigen::Vector3d::Zero();   ///< [m] centre of the object to be touched
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< direction from the centre to the hand
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();    ///< axis about which strokes and circles turn
  double radius = 0.045, sweep = 0.9, rise = 0.008;   ///< [m], [rad], [m]
  double rate = 0.3;                                  ///< [Hz]
  double approach = 0.02, lead_in = 0.5;              ///< [m], [s]
  double tremor = 0.05, wander = 0.1;                 ///< [N] rms of the forces at 8 to 12 Hz and at 0.2 to 1 Hz
  uint64_t seed = 1;
};

struct HandTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();  ///< [m], [m/s]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< [N] tremor, wander, and the force of a guided hand
};

/// A narrow-band random force of given rms: a sum of sinusoids with random frequencies and phases, drawn once.
class BandNoise {
 public:
  BandNoise(double rms, double low_hz, double high_hz, uint64_t seed);
  Eigen::Vector3d at(double t) const noexcept;  ///< [rt] force [N] at time t [s]

 private:
  static constexpr size_t kTones = 4;
  double amplitude_;
  std::array<std::array<double, kTones>, 3> rate_{}, phase_{};
};

class Hand {
 public:
  /// [main] Throws std::invalid_argument with a message for the user.
  Hand(const HandSettings& settings, HandPath path);

  /// [rt] Returns the target of the hand `t` [s] after the start.
  HandTarget at(double t) const noexcept;

  /// [rt] Sets the target of a guided hand from now on.
  void guide(const HandTarget& target) noexcept { guided_ = target; }

  bool holds() const noexcept { return settings_.script != Script::kNone; }
  const HandSettings& settings() const noexcept { return settings_; }
  const HandPath& path() const noexcept { return path_; }  ///< [main]

 private:
  void script(double t, Eigen::Vector3d& position, Eigen::Vector3d& velocity) const noexcept;
  Eigen::Vector3d onArc(double angle) const noexcept {
    return std::sin(angle) * side_ + std::cos(angle) * settings_.normal;
  }

  HandSettings settings_;
  HandPath path_;
  Eigen::Vector3d side_;  ///< unit vector, perpendicular to axis and normal
  HandTarget guided_;
  BandNoise tremor_, wander_;
};

}  // namespace hapticd::simulated
