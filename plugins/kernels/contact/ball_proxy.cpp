// SPDX-License-Identifier: MIT
#include "kernels/contact/ball_proxy.hpp"

#include <algorithm>

namespace hapticd::contact {

/// Moves the centre by `stride` times the way to the target: as far as the last foot has shown to be free, or by a
/// radius, so that the ball does not pass over a ridge. The last foot of a tick goes all the way, however far it is.
void BallProxy::moveTo(const Eigen::Vector3d& target, double stride, double radius, int feet_left) noexcept {
  const Eigen::Vector3d way = stride * (target - center_);
  const double length = way.norm(), longest = std::max({gap_, radius, length / feet_left});
  if (stride == 1 && length <= longest) {
    center_ = target;
    return;
  }
  center_ += std::min(1.0, longest / length) * way;
  center_ -= std::min(bound_.height(center_), 0.0) * bound_.normal;  // beyond the target the way leads below the plane
}

/// Chooses how far the next move goes. On a convex surface of the radius R the nearest place in the tangent plane falls
/// short of the nearest place on the surface, by the share l = depth / (R + radius) of the way. So the ways to the
/// target shrink like a geometric series, and two of them tell how far it goes (Aitken's process; Burden and Faires,
/// Numerical Analysis, 9th ed., 2.5). On flat and concave surfaces the target is the goal.
/// @param before, now the way to the target before the last move and after it [m]
void BallProxy::adaptStride(bool clear, const Eigen::Vector3d& before, const Eigen::Vector3d& now) noexcept {
  constexpr double kLongest = 8;
  const double shrunk = before.squaredNorm() > 0 ? 1 - now.dot(before) / before.squaredNorm() : 1;
  stride_ = clear ? std::clamp(stride_ / std::max(shrunk, 1 / kLongest), 1.0, kLongest) : 1;
}

/// Takes the foot of the centre, and sets the plane that it puts before the ball. A ball that is inside is pushed out
/// along the normal; or if that plane would cut off the place where the ball was free, as on the far side of a convex
/// edge, the ball returns there, and the plane is that of the foot seen from there.
/// @return gap between ball and surface [m], < 0 if the ball was inside
double BallProxy::look(const Foot& foot, double radius) noexcept {
  constexpr double kNoDirection = 1e-9;  // [m] on the surface, rounding errors would give the direction
  const auto setBound = [&](const Eigen::Vector3d& normal) { bound_ = {normal, normal.dot(foot.point) + radius}; };
  const bool outside = !(foot.depth > 0);
  const bool clear = outside && foot.distance > kNoDirection;
  setBound(clear ? Eigen::Vector3d((center_ - foot.point) / foot.distance) : foot.normal);
  const double gap = (outside ? foot.distance : -foot.depth) - radius;
  gap_ = std::max(gap, 0.0);
  if (gap > -kSettled) {
    reached_ = center_;
    has_reached_ = true;
  } else if (has_reached_ && bound_.height(reached_) < -kSettled) {
    center_ = reached_;
    setBound((reached_ - foot.point).normalized());
  }
  if (gap < 0) center_ -= std::min(bound_.height(center_), 0.0) * bound_.normal;
  return gap;
}

/// Returns the nearest place to p that the planes leave free. It cannot be farther from p than a place that was seen to
/// be free, unless planes of different parts of a curved surface contradict each other: then only the newest counts, or
/// none.
Eigen::Vector3d BallProxy::nearestFree(HalfSpaces& free, const Eigen::Vector3d& p) const noexcept {
  const double farthest = (reached_ - p).norm() + kSettled;
  const auto isFar = [&](const Eigen::Vector3d& target) { return has_reached_ && (target - p).norm() > farthest; };
  Eigen::Vector3d target = free.nearestTo(p);
  if (!isFar(target)) return target;
  free.clear();
  free.add(bound_);
  target = free.nearestTo(p);
  return isFar(target) ? reached_ : target;
}

/// Makes the foot of the last centre that of the ball.
Foot BallProxy::felt(Foot foot, const Eigen::Vector3d& p) noexcept {
  if (!found(foot) || !has_reached_) {
    forget();
    if (found(foot)) foot.status = FootStatus::kDegraded;
    foot.distance = (p - foot.point).norm();
    foot.depth = -foot.distance;
    return foot;
  }
  const Eigen::Vector3d out = center_ - p;
  lag_ = out.norm();
  foot.normal = lag_ > kSettled ? Eigen::Vector3d(out / lag_) : bound_.normal;
  foot.depth = lag_ > 0 ? lag_ : -gap_;
  foot.distance = std::abs(foot.depth);
  foot.point = lag_ > 0 ? center_ : Eigen::Vector3d(p - gap_ * bound_.normal);
  return foot;
}

}  // namespace hapticd::contact
