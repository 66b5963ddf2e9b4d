#include "hand.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::simulated {

using Eigen::Vector3d;

Vector3d Hand::where(double t) const noexcept {
  constexpr double kApproach = 0.5;  // [s] from the neutral pose to the script
  const double phase = 2 * M_PI * settings_.rate * t;
  Vector3d wanted = settings_.center;
  switch (settings_.script) {
    case Script::kHold: break;
    case Script::kStroke: {
      const double angle = settings_.sweep * std::sin(phase);
      wanted += Vector3d(settings_.radius * std::sin(angle), settings_.rise * std::sin(0.31 * phase),
                         settings_.radius * std::cos(angle));
      break;
    }
    case Script::kPress: wanted.z() += settings_.radius - settings_.rise * 0.5 * (1 - std::cos(phase)); break;
    case Script::kTap: wanted.z() += settings_.radius - settings_.rise * std::sin(phase); break;
    case Script::kCircle:
      wanted += Vector3d(settings_.radius * std::sin(phase), 0, settings_.radius * std::cos(phase));
      break;
  }
  const double s = std::clamp(t / kApproach, 0.0, 1.0);
  return wanted * (s * s * (3 - 2 * s));
}

void Hand::target(double t, Vector3d& position, Vector3d& velocity) const noexcept {
  constexpr double kStep = 1e-5;  // [s] the scripts are smooth: differences are exact enough for a damper
  position = where(t);
  velocity = (where(t + kStep) - where(t - kStep)) / (2 * kStep);
}

void Hand::drawTremor(double dt) noexcept {
  constexpr double kCorner = 2 * M_PI * 10;  // [rad/s] physiological tremor lies near 10 Hz
  const double keep = std::exp(-kCorner * dt), gain = settings_.tremor * std::sqrt(1 - keep * keep);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 3; ++i) tremor_[i] = keep * tremor_[i] + gain * normal(random_);
}

Vector3d Hand::force(double t, const Vector3d& position, const Vector3d& velocity) const noexcept {
  Vector3d wanted, wanted_velocity;
  target(t, wanted, wanted_velocity);
  return settings_.stiffness * (wanted - position) + settings_.damping * (wanted_velocity - velocity) + tremor_;
}

}  // namespace hapticd::simulated
