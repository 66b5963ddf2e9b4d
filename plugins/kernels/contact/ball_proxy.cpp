// SPDX-License-Identifier: MIT
#include "kernels/contact/ball_proxy.hpp"

#include <algorithm>

namespace hapticd::contact {

/// Moves the centre by `stride` times the distance to the target, by `longest` [m] at most.
void BallProxy::moveTo(const Eigen::Vector3d& target, double stride, double longest) noexcept {
  const Eigen::Vector3d motion = stride * (target - center_);
  const double length = motion.norm();
  if (stride == 1 && length <= longest) {
    center_ = target;
    return;
  }
  center_ += std::min(1.0, longest / length) * motion;
  center_ -= std::min(bound_.height(center_), 0.0) * bound_.normal;  // beyond the target it may be below the plane
}

/// Chooses how far the next move goes. On a convex surface of the radius R the nearest place in the tangent plane falls
/// short of the nearest place on the surface, by the share l = depth / (R + radius) of the distance. So the
/// distances to the target shrink like a geometric series, and two of them show its end (Aitken's process; Burden and
/// Faires, Numerical Analysis, 9th ed., 2.5). On flat and concave surfaces the target is the goal.
/// @param before, now from the centre to the target before the last move and after it [m]
void BallProxy::adaptStride(bool clear, const Eigen::Vector3d& before, const Eigen::Vector3d& now) noexcept {
  constexpr double kLongest = 8;
  const double shrunk = before.squaredNorm() > 0 ? 1 - now.dot(before) / before.squaredNorm() : 1;
  stride_ = clear ? std::clamp(stride_ / std::max(shrunk, 1 / kLongest), 1.0, kLongest) : 1;
}

/// Turns the plane about its foot, so that it faces a ball about `center`.
void BallProxy::faceFrom(const Eigen::Vector3d& center, double radius) noexcept {
  bound_ = beyond(support_.point, (center - support_.point).normalized(), radius);
}

/// Takes the foot of the centre, and sets the plane that it puts before the ball. A ball that is inside is pushed out
/// along the normal; or if that plane would cut off the place where the ball was free, as on the far side of a convex
/// edge, the ball returns there, and the plane is that of the foot seen from there.
/// @return gap between ball and surface [m], < 0 if the ball was inside
double BallProxy::look(const Foot& foot, const Eigen::Vector3d& p, double radius) noexcept {
  constexpr double kNoDirection = 1e-9;  // [m] on the surface, rounding errors would give the direction
  const bool outside = !(foot.depth > 0);
  support_ = {foot.point, foot.u, foot.v, foot.residual, foot.surface, foot.on_edge};
  bound_ = beyond(foot.point, foot.normal, radius);
  if (outside && foot.distance > kNoDirection) faceFrom(center_, radius);
  const double gap = (outside ? foot.distance : -foot.depth) - radius;
  gap_ = std::max(gap, 0.0);
  if ((reached_ - foot.point).norm() < radius - kSettled) has_reached_ = false;  // an uncertain foot was wrong there
  const bool fits = gap > -kSettled;
  if (!fits && has_reached_ && bound_.height(reached_) < -kSettled) {
    center_ = reached_;
    faceFrom(reached_, radius);
  }
  if (gap < 0) center_ -= std::min(bound_.height(center_), 0.0) * bound_.normal;
  if (!fits) return gap;
  if (!has_reached_ || (center_ - p).norm() < (reached_ - p).norm() + kSettled) reached_ = center_;
  fits_ = has_reached_ = true;
  return gap;
}

/// Returns the nearest place to p that the planes leave free. It cannot be farther from p than a place that was seen to
/// be free (or than a radius more, if a foot has shown that it was not), unless planes of different parts of a curved
/// surface or wrong feet contradict each other: then only the newest counts, or none.
Eigen::Vector3d BallProxy::nearestFree(const Eigen::Vector3d& p, double radius) noexcept {
  const double farthest = (reached_ - p).norm() + (has_reached_ ? kSettled : radius);
  const auto isFar = [&](const Eigen::Vector3d& target) { return fits_ && (target - p).norm() > farthest; };
  Eigen::Vector3d target = supports_.nearestTo(p);
  if (!isFar(target)) return target;
  supports_.clear();
  supports_.add(bound_, support_);
  target = supports_.nearestTo(p);
  return isFar(target) ? reached_ : target;
}

/// Of the feet that hold the ball, the one whose face pushes most counts. It stays, unless another pushes clearly more:
/// else the feature, u and v would flicker in a groove.
/// @param out from the probe to the centre [m]
void BallProxy::chooseFoot(const Eigen::Vector3d& out, Foot& foot) noexcept {
  constexpr double kClearly = 0.05;  // share of the whole push
  const auto push = [&](std::size_t i) { return supports_.normal(i).dot(out); };
  const auto away = [&](std::size_t i) { return (supports_[i].point - last_foot_).squaredNorm(); };
  std::size_t most = 0, same = 0;
  for (std::size_t i = 1; i < supports_.size(); ++i) {
    if (push(i) > push(most)) most = i;
    if (away(i) < away(same)) same = i;
  }
  if (supports_.size() > 0) {
    const bool stays = push(most) < push(same) + kClearly * out.norm();
    const Support& felt = supports_[stays ? same : most];
    foot.point = felt.point;
    foot.u = felt.u;
    foot.v = felt.v;
    foot.residual = felt.residual;
    foot.surface = felt.surface;
    foot.on_edge = felt.on_edge;
  }
  last_foot_ = foot.point;
}

/// Makes the foot of the last centre that of the ball. If the feet did not suffice, the ball stays where it was seen to
/// be free: in a place that no foot has tested, its spring might gain energy.
Foot BallProxy::felt(Foot foot, const Eigen::Vector3d& p, double radius) noexcept {
  const double lag = lag_ = (asked_ - p).norm();
  if (found(foot) && has_reached_ && center_ != reached_) {
    center_ = reached_;
    gap_ = 0;
    faceFrom(center_, radius);
    supports_.turnTo(center_, radius);
  }
  if (!found(foot) || !fits_ || (waits_ && (center_ - p).norm() > kSettled)) {
    const bool waits = waits_ || found(foot);
    forget();
    waits_ = waits;
    lag_ = lag;
    if (found(foot)) foot.status = FootStatus::kDegraded;
    foot.distance = (p - foot.point).norm();
    foot.depth = -foot.distance;
    return foot;
  }
  waits_ = false;
  const Eigen::Vector3d out = center_ - p;
  const double depth = out.norm();
  chooseFoot(out, foot);
  if (depth > radius && foot.status == FootStatus::kNearest) foot.status = FootStatus::kHeld;  // the tip is not outside
  foot.normal = depth > kSettled ? Eigen::Vector3d(out / depth) : bound_.normal;
  foot.depth = depth > 0 ? depth : -gap_;
  foot.distance = std::abs(foot.depth);
  foot.point = depth > 0 ? center_ : Eigen::Vector3d(p - gap_ * bound_.normal);
  return foot;
}

}  // namespace hapticd::contact
