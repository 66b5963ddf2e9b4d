// SPDX-License-Identifier: MIT
#include "simulated/hand.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hapticd::simulated {

using Eigen::Vector3d;

namespace {

/// Random numbers by SplitMix64 (Steele, Lea & Flood 2014): the same on every machine and with every library.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  double uniform() {  ///< returns a number in [0, 1)
    uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  uint64_t state_;
};

Vector3d unit(const Vector3d& direction, const char* what) {
  if (!(direction.norm() > 1e-9)) throw std::invalid_argument(std::string(what) + " is zero, expected a direction");
  return direction.normalized();
}

}  // namespace

BandNoise::BandNoise(double rms, double low_hz, double high_hz, uint64_t seed)
    : amplitude_(rms * std::sqrt(2.0 / static_cast<double>(kTones))) {
  Random random(seed);
  for (size_t axis = 0; axis < 3; ++axis)
    for (size_t tone = 0; tone < kTones; ++tone) {
      // One tone in each part of the band, so that no two tones are close and beat slowly.
      const double place = (static_cast<double>(tone) + random.uniform()) / static_cast<double>(kTones);
      rate_[axis][tone] = 2 * M_PI * (low_hz + place * (high_hz - low_hz));
      phase_[axis][tone] = 2 * M_PI * random.uniform();
    }
}

Vector3d BandNoise::at(double t) const noexcept {
  Vector3d sum = Vector3d::Zero();
  if (amplitude_ == 0) return sum;
  for (size_t axis = 0; axis < 3; ++axis)
    for (size_t tone = 0; tone < kTones; ++tone)
      sum[static_cast<int>(axis)] += std::sin(rate_[axis][tone] * t + phase_[axis][tone]);
  return amplitude_ * sum;
}

Hand::Hand(const HandSettings& settings, HandPath path)
    : settings_(settings),
      path_(std::move(path)),
      tremor_(settings.tremor, 8, 12, settings.seed),
      wander_(settings.wander, 0.2, 1, ~settings.seed) {
  settings_.normal = unit(settings.normal, "hand.normal");
  settings_.axis = unit(settings.axis, "hand.axis");
  side_ = settings_.axis.cross(settings_.normal);
  if (!(side_.norm() > 1e-3)) {
    if (settings.script == Script::kStroke || settings.script == Script::kCircle)  // the others move along the normal
      throw std::invalid_argument("hand.axis is parallel to hand.normal; expected two different directions");
    side_ = settings_.normal.unitOrthogonal();
  }
  side_.normalize();
  settings_.axis = settings_.normal.cross(side_);
  guided_.position = settings_.center + settings_.radius * settings_.normal;
  if (settings_.script == Script::kPath && path_.empty())
    throw std::invalid_argument("hand.script is path, but hand.path names no file; expected a CSV file t,x,y,z");
}

void Hand::script(double t, Vector3d& position, Vector3d& velocity) const noexcept {
  const HandSettings& s = settings_;
  const double rate = 2 * M_PI * s.rate, phase = rate * t;
  velocity.setZero();
  position = s.center + s.radius * s.normal;
  switch (s.script) {
    case Script::kStroke: {
      constexpr double kRiseRatio = 0.31;  // no simple fraction, so that the strokes cover an area instead of one line
      const double angle = s.sweep * std::sin(phase), angle_rate = s.sweep * rate * std::cos(phase);
      position = s.center + s.radius * onArc(angle) + s.rise * std::sin(kRiseRatio * phase) * s.axis;
      velocity = s.radius * angle_rate * onArc(angle + M_PI / 2) +
                 s.rise * kRiseRatio * rate * std::cos(kRiseRatio * phase) * s.axis;
      break;
    }
    case Script::kCircle:
      position = s.center + s.radius * onArc(phase);
      velocity = s.radius * rate * onArc(phase + M_PI / 2);
      break;
    case Script::kPress:  // moves in and out again smoothly, from 0 to `rise` deep
      position -= s.rise * 0.5 * (1 - std::cos(phase)) * s.normal;
      velocity = -s.rise * 0.5 * rate * std::sin(phase) * s.normal;
      break;
    case Script::kTap:  // moves as far out as it moves in
      position -= s.rise * std::sin(phase) * s.normal;
      velocity = -s.rise * rate * std::cos(phase) * s.normal;
      break;
    case Script::kPath:
      path_.at(t, position, velocity);
      break;
    case Script::kGuided:
      position = guided_.position;
      velocity = guided_.velocity;
      break;
    case Script::kHold:
    case Script::kNone:
      break;
  }
}

HandTarget Hand::at(double t) const noexcept {
  HandTarget target;
  script(t, target.position, target.velocity);
  target.force = tremor_.at(t) + wander_.at(t);
  if (settings_.script == Script::kGuided) target.force += guided_.force;
  const bool leads_in = settings_.script != Script::kPath && settings_.script != Script::kGuided;
  if (!leads_in || t >= settings_.lead_in) return target;
  const double s = std::max(t, 0.0) / settings_.lead_in;
  target.position += settings_.approach * (1 - s * s * (3 - 2 * s)) * settings_.normal;
  target.velocity -= settings_.approach * 6 * s * (1 - s) / settings_.lead_in * settings_.normal;
  return target;
}

}  // namespace hapticd::simulated
