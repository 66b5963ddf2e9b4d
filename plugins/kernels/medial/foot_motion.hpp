// SPDX-License-Identifier: MIT
/// The motion of a foot as its probe moves.
#pragma once
#include <algorithm>

#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {

/// Derivatives of a foot over the position of its probe. A motion of the probe along the direction from the foot does
/// not move the foot; only motion across this direction does.
struct FootMotion {
  Eigen::Vector3d toward_u{0, 0, 0}, toward_v{0, 0, 0};    ///< [1/m] gradients of the foot's parameters u and v
  Eigen::Vector3d tangent_u{0, 0, 0}, tangent_v{0, 0, 0};  ///< [m] tangents of the skeleton at the foot
  /// [1/m] rotation of the direction to the probe per metre of motion across it, while the foot stays
  double turn = 0;
};

/// if the cosine between a direction and that of the foot is above this, they count as equal
inline constexpr double kSameDirection = 0.99;
/// if this cosine is below kTurned, the directions are different
inline constexpr double kTurned = 0.9;

/// [rt] Returns 1 if a direction with this cosine to the direction of the foot counts as equal to it, and 0 if as
/// different; values between blend the two cases.
inline double directness(double cosine) noexcept {
  return std::clamp((cosine - kTurned) / (kSameDirection - kTurned), 0.0, 1.0);
}

/// [rt] Returns the motion of a foot, from the derivative of the condition that makes it a foot, d|p - S|/du = dr/du.
/// @param direct 1 if `normal` is the direction from the foot to the probe. 0 if it is not, because the probe was
/// pushed through the skeleton: the foot then moves as on a flat skeleton, and the direction stays. Values between
/// blend the two cases
FootMotion footMotion(const Skeleton& skeleton, const Eigen::Vector3d& p, const SkeletonFoot& foot,
                      const Eigen::Vector3d& normal, Envelope envelope, double direct) noexcept;

}  // namespace hapticd::medial
