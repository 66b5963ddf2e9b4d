// SPDX-License-Identifier: MIT
/// How the foot of a probe moves with the probe.
#pragma once
#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {

/// Derivatives of a foot. The foot is stationary along the direction to the probe, so only motion aside moves it.
struct FootMotion {
  Eigen::Vector3d toward_u{0, 0, 0}, toward_v{0, 0, 0};    ///< [1/m] gradients of its parameters
  Eigen::Vector3d tangent_u{0, 0, 0}, tangent_v{0, 0, 0};  ///< [m] of the skeleton there
  double turn = 0;  ///< [1/m] by which the direction to the probe turns while the foot stays
};

/// [rt] From the condition of the foot, d|p - S|/du = dr/du, differentiated.
/// @param direct 1: `normal` is the direction from the foot to the probe. Where the probe was pushed through the
/// skeleton it is no more, 0: the foot then follows as on a flat skeleton, and the direction stays; between, in part
FootMotion footMotion(const Skeleton& skeleton, const Eigen::Vector3d& p, const SkeletonFoot& foot,
                      const Eigen::Vector3d& normal, Envelope envelope, double direct) noexcept;

}  // namespace hapticd::medial
