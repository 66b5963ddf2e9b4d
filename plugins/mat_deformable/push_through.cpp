#include "push_through.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd {
namespace {

using Eigen::Vector3d;

constexpr double kDeepest = 1.0 / 3;  ///< of the radius left under a stroke whose direction is still followed at once
constexpr double kOpposite = 1e-9;    ///< directions nearer to opposite than this have no plane to turn in

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

}  // namespace

Felt feltTurning(const Vector3d& p, const Vector3d& moved, Track& track) noexcept HSP_RT {
  const medial::SkeletonFoot& foot = track.foot;
  if (!(foot.depth > 0)) {
    track.pushed.setZero();
    return {foot.normal, foot.depth};
  }
  const bool entered = track.pushed.isZero(0);
  Vector3d wanted = foot.normal;
  if (!entered && !foot.rim && wanted.dot(track.pushed) < 0)  // on the other side of a sheet
    wanted -= 2 * wanted.dot(foot.across) * foot.across;
  const double aside = (moved - moved.dot(track.pushed) * track.pushed).norm();
  // A stroke round the foot turns by its length over its distance from the middle; one that is beyond it, more slowly.
  const double arm =
      track.pushed.dot(foot.normal) < 0 ? foot.radius : std::max(foot.radius - foot.depth, kDeepest * foot.radius);
  const double angle = arm > 0 ? aside / arm : M_PI;
  track.pushed = entered ? wanted : turned(track.pushed, wanted, angle).normalized();
  const double through = -track.pushed.dot(foot.normal);
  if (!(through > 0)) return {track.pushed, foot.depth};
  // Along the direction from p to the sphere about the foot.
  const Vector3d d = p - foot.center;
  const double along = d.dot(track.pushed);
  const double way = std::sqrt(std::max(0.0, along * along + foot.radius * foot.radius - d.squaredNorm())) - along;
  return {track.pushed, foot.depth + through * std::max(0.0, way - foot.depth)};
}

}  // namespace hapticd
