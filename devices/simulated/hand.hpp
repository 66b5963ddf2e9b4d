/// A simulated hand: a mass at the tip, held by a spring and damper to a target that follows a script.
#pragma once
#include <Eigen/Core>
#include <random>

namespace hapticd::simulated {

enum class Script { kHold, kStroke, kPress, kTap, kCircle };

struct HandSettings {
  double mass = 0.2, stiffness = 300, damping = 6;  ///< [kg], [N/m], [N s/m]
  Script script = Script::kStroke;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m] device frame
  double radius = 0.05;      ///< [m] of the arc or circle about the vertical through the centre
  double sweep = 1.0;        ///< [rad] to either side of an arc
  double rise = 0.01;        ///< [m] up and down along an arc; depth of a tap or press
  double rate = 0.3;         ///< [Hz]
  double tremor = 0.05;      ///< [N] rms of the hand's own noise
};

class Hand {
 public:
  Hand(const HandSettings& settings, unsigned seed) : settings_(settings), random_(seed) {}

  /// [rt] Where the script wants the tip at time t [s], and how fast.
  void target(double t, Eigen::Vector3d& position, Eigen::Vector3d& velocity) const noexcept;

  /// [rt] Draws the tremor of the next tick [N]; low-pass filtered to the band of a hand.
  void drawTremor(double dt) noexcept;

  /// [rt] Force [N] on the tip at a position and velocity.
  Eigen::Vector3d force(double t, const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) const noexcept;

  double mass() const noexcept { return settings_.mass; }

 private:
  Eigen::Vector3d where(double t) const noexcept;
  HandSettings settings_;
  std::mt19937_64 random_;
  Eigen::Vector3d tremor_ = Eigen::Vector3d::Zero();
};

}  // namespace hapticd::simulated
