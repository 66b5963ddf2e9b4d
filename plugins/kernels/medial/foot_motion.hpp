// SPDX-License-Identifier: MIT
/// How the foot of a probe moves with the probe.
#pragma once
#include "kernels/medial/skeleton.hpp"

namespace hapticd::medial {

/// Derivatives of a foot. The foot is stationary along the direction to the probe: only motion aside moves it.
struct FootMotion {
  Eigen::Vector3d toward_u{0, 0, 0}, toward_v{0, 0, 0};    ///< [1/m] gradients of its parameters
  Eigen::Vector3d tangent_u{0, 0, 0}, tangent_v{0, 0, 0};  ///< [m] of the skeleton there
  double turn = 0;  ///< [1/m] by which the direction to the probe turns while the foot stays
};

/// [rt] From the condition of the foot, d|p - S|/du = dr/du, differentiated. `direct`: `normal` is the direction from
/// the foot to the probe, which it is no more where the probe was pushed through the skeleton.
FootMotion footMotion(const Skeleton& skeleton, const Eigen::Vector3d& p, const SkeletonFoot& foot,
                      const Eigen::Vector3d& normal, Envelope envelope, bool direct) noexcept;

}  // namespace hapticd::medial
