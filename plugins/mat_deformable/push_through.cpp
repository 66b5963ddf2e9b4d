// SPDX-License-Identifier: MIT
#include "push_through.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd {
namespace {

using Eigen::Vector3d;

/// share of the radius; if the probe is nearer to the middle than this, the direction no longer follows a stroke at
/// once
constexpr double kDeepest = 1.0 / 3;
/// two directions that are nearer to opposite than this have no plane in which to turn
constexpr double kOpposite = 1e-9;
/// below this cosine, two feet are opposite, and neither adds to the push of the other
constexpr double kOppositeFeet = -0.95;
/// a direction whose cosine to the sheet's normal is smaller points to neither side of the sheet
constexpr double kSideways = 0.5;
constexpr double kSettled = 1 - 1e-14;  ///< directions with a greater cosine count as the same
/// least cosine of the outward direction and its mirror image that is used as a divisor
constexpr double kLeastMirror = 0.1;

/// Returns the direction `from`, turned toward `to` by at most `angle` [rad].
Vector3d turned(const Vector3d& from, const Vector3d& to, double angle) noexcept {
  const double cosine = std::clamp(from.dot(to), -1.0, 1.0);
  const double between = std::acos(cosine);
  if (between <= angle) return to;
  const Vector3d aside = to - cosine * from;
  const double length = aside.norm();
  if (!(length > kOpposite)) return from;
  return std::cos(angle) * from + std::sin(angle) / length * aside;
}

/// Returns the length [m] by which the path of a stroke is divided to get the turn of the direction. It is the probe's
/// distance from the middle; beyond the middle it is greater, so that the direction turns more slowly.
double armOf(const medial::SkeletonFoot& foot, const Vector3d& pushed) noexcept {
  return pushed.dot(foot.normal) < 0 ? foot.radius : std::max(foot.radius - foot.depth, kDeepest * foot.radius);
}

double asideOf(const Vector3d& moved, const Vector3d& pushed) noexcept {
  return (moved - moved.dot(pushed) * pushed).norm();
}

/// Returns the distance [m] from p to the sphere of the foot, along the direction of the push.
double wayOut(const Vector3d& p, const Track& track) noexcept {
  const Vector3d d = p - track.foot.center;
  const double along = d.dot(track.pushed), radius = track.foot.radius;
  return std::sqrt(std::max(0.0, along * along + radius * radius - d.squaredNorm())) - along;
}

/// Returns the felt surface of a probe that has left the body. If it left on the far side, it is still pushed back,
/// with a force that fades out.
Felt outside(const Vector3d& p, bool fades, Track& track) noexcept {
  const medial::SkeletonFoot& foot = track.foot;
  const double left = foot.radius > 0 ? 1 + foot.depth / foot.radius : 0, through = -track.pushed.dot(foot.normal);
  if (fades && left > 0 && through > 0) {
    const double depth = left * through * wayOut(p, track);
    if (depth > 0) return {track.pushed, depth};
  }
  track.side = 0;
  track.pushed.setZero();
  return {foot.normal, foot.depth};
}

/// Turns the direction of the push toward `wanted`, for a probe that moved by `way` [m].
void turn(const Vector3d& wanted, double way, Track& track) noexcept {
  const double arm = armOf(track.foot, track.pushed);
  track.pushed = turned(track.pushed, wanted, arm > 0 ? way / arm : M_PI).normalized();
}

}  // namespace

Felt feltTurning(const Vector3d& p, const Vector3d& moved, bool fades, Track& track) noexcept HSP_RT {
  const medial::SkeletonFoot& foot = track.foot;
  if (!(foot.depth > 0)) return outside(p, fades, track);
  const bool entered = track.pushed.isZero(0);
  Vector3d wanted = foot.normal;
  if (!entered && !foot.rim && wanted.dot(track.pushed) < 0)  // the probe is on the other side of a sheet
    wanted -= 2 * wanted.dot(foot.across) * foot.across;
  const bool clear = foot.radius - foot.depth > kDeepest * foot.radius && foot.normal.dot(track.pushed) > 0;
  // A probe that was pushed through, or whose two feet are opposite, is still pushed back to where it came from.
  const bool other =
      track.swapped && track.pushed.dot(track.rival.normal) > 0 && foot.normal.dot(track.rival.normal) > kOppositeFeet;
  if (entered || (track.settled && (other || clear))) {
    track.pushed = other ? foot.normal : wanted;
  } else {
    turn(wanted, asideOf(moved, track.pushed), track);
  }
  track.settled = track.pushed.dot(wanted) > kSettled;
  const double through = -track.pushed.dot(foot.normal);
  if (!(through > 0)) return {track.pushed, foot.depth};
  return {track.pushed, foot.depth + through * std::max(0.0, wayOut(p, track) - foot.depth)};
}

Felt feltOnSheet(const Vector3d& p, const Vector3d& moved, bool fades, Track& track) noexcept HSP_RT {
  const medial::SkeletonFoot& foot = track.foot;
  if (!(foot.depth > 0)) return outside(p, fades, track);
  const bool entered = track.pushed.isZero(0), rim = foot.rim || foot.across.isZero(0);
  const double cosine = foot.normal.dot(foot.across), lean = track.pushed.dot(foot.across);
  if (entered || (rim && std::fabs(lean) < kSideways)) {
    track.side = 0;
  } else if (rim) {
    track.side = lean < 0 ? -1 : 1;
  }
  Vector3d wanted = foot.normal;
  if (!rim) {
    if (track.side == 0) track.side = cosine < 0 ? -1 : 1;
    if (track.side * cosine < 0) wanted -= 2 * cosine * foot.across;
  }
  if (entered || (!rim && track.settled)) {
    track.pushed = wanted;
    track.settled = !rim;
  } else {
    turn(wanted, rim ? asideOf(moved, track.pushed) : moved.norm(), track);
    track.settled = !rim && track.pushed.dot(wanted) > kSettled;
  }
  double through = track.side * cosine < 0 ? 1 : 0;  // 1 if the probe is beyond the middle
  if (!track.settled) {
    const double mirror = std::max(kLeastMirror, 1 - 2 * foot.slope * foot.slope);
    through = std::clamp(-track.pushed.dot(foot.normal) / mirror, 0.0, 1.0);
  }
  return {track.pushed, foot.depth + 2 * through * (foot.radius - foot.depth)};
}

}  // namespace hapticd
