// SPDX-License-Identifier: MIT
#include "operator.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::table1 {

using Eigen::Vector3d;

Operator::Operator(const Protocol& protocol, std::function<Aim(double)> route)
    : protocol_(protocol),
      route_(std::move(route)),
      random_(protocol.seed),
      seen_(static_cast<size_t>(std::max(1.0, protocol.visual_delay * protocol.rate))) {}

/// Returns the push [N]: the mean push, varied by an Ornstein-Uhlenbeck process and a tremor.
double Operator::push(double t, double dt) {
  const double pole = 2 * M_PI * protocol_.spread_rate, keep = std::exp(-pole * dt);
  wander_ = keep * wander_ + std::sqrt(1 - keep * keep) * normal_(random_);
  wander_ = std::clamp(wander_, -protocol_.most, protocol_.most);
  const double tremor = protocol_.tremor * std::sin(2 * M_PI * protocol_.tremor_rate * t);
  return protocol_.force * std::max(0.0, 1 + protocol_.spread * wander_ + tremor);
}

/// Returns the distance [m] of the target point outside the surface. It is -depth, but every few seconds the finger is
/// lifted and comes down again.
double Operator::outward(double t, double depth) const {
  constexpr double kRise = 0.3;  // [s]
  const double phase = std::fmod(t, protocol_.touch_every);
  // [s] time from the highest point to the target point
  const double down = (protocol_.lift + depth) / protocol_.touch_speed;
  const double begin = protocol_.touch_every - kRise;
  if (phase >= begin) {
    const double s = (phase - begin) / kRise;
    return -depth + (protocol_.lift + depth) * s * s * (3 - 2 * s);
  }
  if (phase < down) return protocol_.lift - protocol_.touch_speed * phase;
  return -depth;
}

Wish Operator::wish(double t, double dt, const hsp_pose& pose) {
  if (!started_) std::fill(seen_.begin(), seen_.end(), pose);
  const hsp_pose late = seen_[next_];
  seen_[next_] = pose;
  next_ = (next_ + 1) % seen_.size();

  const Aim aim = route_(t);
  const double most = protocol_.room_used * aim.room;
  const Eigen::Quaterniond q(late.orientation[0], late.orientation[1], late.orientation[2], late.orientation[3]);
  const auto at = [&](double force) -> Vector3d {
    const double depth = std::min(force / protocol_.stiffness, most);
    return Vector3d(late.position) + q * (aim.point + outward(t, depth) * aim.normal);
  };
  Wish wish;
  wish.position = at(push(t, dt));
  // The damper acts between the finger and the motion of the hand. That motion is computed with the mean push, because
  // variations of the push are forces and not motions.
  const Vector3d way = at(protocol_.force);
  if (started_ && dt > 0) wish.velocity = (way - last_) / dt;
  last_ = way;
  started_ = true;
  return wish;
}

}  // namespace hapticd::table1
