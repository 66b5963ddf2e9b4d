// SPDX-License-Identifier: MIT
#include "servo/safety/energy_account.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::servo {

namespace {

/// Returns what is left of an energy [J] after a step. What friction and damping took cannot be given back, so it must
/// not hide what is given later. @param stored [J] that may come back @param allowed [J] that may be given in a step
double closed(double given, double stored, double allowed) noexcept HSP_RT {
  given = std::max(given, -stored);
  if (given > 0) given = std::max(0.0, given - allowed);
  return std::isfinite(given) ? given : 0;
}

}  // namespace

bool EnergyAccount::step(const Push& push, double dt, double reported, double most_force) noexcept HSP_RT {
  // The shape itself reports the depth. No hand presses deeper than kDistance, so a wrong depth is no credit without
  // bound.
  const double stored = push.force.norm() * std::clamp(push.depth, 0.0, kDistance);
  const Eigen::Vector3d motion = push.position - last_.position;
  const double unseen =
      met_ ? std::min(stored, std::max(push.force.norm(), last_.force.norm()) * motion.norm()) : stored;
  // Nobody knows how a probe that jumped came to its depth, nor what a new value stores there. So it counts as pressed
  // by a hand, over the distance that nobody saw.
  double all = -unseen, surface = push.surface ? -(changed_ ? stored : unseen) : 0;
  if (known_) {
    const double before = last_.force.dot(motion) / 2, now = push.force.dot(motion) / 2;
    all = before + now;
    if (!changed_) surface = (last_.surface ? before : 0) + (push.surface ? now : 0);
    // After a late tick, or a jump of the path, a probe that left is far away. It was pushed over its depth alone.
    if (push.force.isZero(0) && last_.depth > 0) {
      all = std::min(all, last_stored_ / 2);
      surface = std::min(surface, last_stored_ / 2);
    }
  }
  last_ = push, last_stored_ = stored;
  met_ = known_ = true, changed_ = false;
  // Friction that sticks is a spring, which may store more than the wall; but not more than an arm can put in.
  const double room = most_force * kDistance;
  const double back = std::max(stored, most_force > 0 ? std::min(reported, room) : reported);
  given_ = closed(given_ + surface, back, kMostPower * dt);
  given_by_all_ = closed(given_by_all_ + all, back, most_force * kSpeed * dt);
  return given_ > kMostGiven || (most_force > 0 && given_by_all_ > room);
}

}  // namespace hapticd::servo
