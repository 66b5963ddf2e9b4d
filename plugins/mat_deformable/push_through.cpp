// SPDX-License-Identifier: MIT
#include "push_through.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd {
namespace {

using Eigen::Vector3d;

constexpr double kDeepest = 1.0 / 3;  ///< of the radius left under a stroke whose direction is still followed at once
constexpr double kOpposite = 1e-9;    ///< directions nearer to opposite than this have no plane to turn in
constexpr double kOppositeFeet = -0.95;  ///< cosine of two feet of which neither pushes with the other
constexpr double kSideways = 0.5;        ///< a direction less across a sheet than this is on neither side of it
constexpr double kSettled = 1 - 1e-14;   ///< cosine of directions that are the same
constexpr double kLeastMirror = 0.1;  ///< cosine of the outward direction and its mirror image that still is a measure

/// `from` turned toward `to` by at most `angle`.
Vector3d turned(const Vector3d& from, const Vector3d& to, double angle) noexcept {
  const double cosine = std::clamp(from.dot(to), -1.0, 1.0);
  const double between = std::acos(cosine);
  if (between <= angle) return to;
  const Vector3d aside = to - cosine * from;
  const double length = aside.norm();
  if (!(length > kOpposite)) return from;
  return std::cos(angle) * from + std::sin(angle) / length * aside;
}

/// A stroke round the foot turns the direction by its length over this [m], its distance from the middle; one that is
/// beyond the middle, more slowly.
double armOf(const medial::SkeletonFoot& foot, const Vector3d& pushed) noexcept {
  return pushed.dot(foot.normal) < 0 ? foot.radius : std::max(foot.radius - foot.depth, kDeepest * foot.radius);
}

double asideOf(const Vector3d& moved, const Vector3d& pushed) noexcept {
  return (moved - moved.dot(pushed) * pushed).norm();
}

/// [m] Along the direction that pushes, from p to the sphere about the foot.
double wayOut(const Vector3d& p, const Track& track) noexcept {
  const Vector3d d = p - track.foot.center;
  const double along = d.dot(track.pushed), radius = track.foot.radius;
  return std::sqrt(std::max(0.0, along * along + radius * radius - d.squaredNorm())) - along;
}

/// A probe that has left the body. On the far side of where it came in it is still pushed back, less and less.
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

/// Turns the direction of the track toward `wanted`, for a probe that moved by `way` [m].
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
  if (!entered && !foot.rim && wanted.dot(track.pushed) < 0)  // on the other side of a sheet
    wanted -= 2 * wanted.dot(foot.across) * foot.across;
  const bool clear = foot.radius - foot.depth > kDeepest * foot.radius && foot.normal.dot(track.pushed) > 0;
  // One that was pushed through, or whose two feet lie opposite, is pushed back to where it came from all the same.
  const bool other =
      track.swapped && track.pushed.dot(track.rival.normal) > 0 && foot.normal.dot(track.rival.normal) > kOppositeFeet;
  if (entered || (fades && track.settled && (other || clear))) {
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
  double through = track.side * cosine < 0 ? 1 : 0;  // beyond the middle
  if (!track.settled) {
    const double mirror = std::max(kLeastMirror, 1 - 2 * foot.slope * foot.slope);
    through = std::clamp(-track.pushed.dot(foot.normal) / mirror, 0.0, 1.0);
  }
  return {track.pushed, foot.depth + 2 * through * (foot.radius - foot.depth)};
}

}  // namespace hapticd
