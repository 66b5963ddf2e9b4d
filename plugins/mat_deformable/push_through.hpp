// SPDX-License-Identifier: MIT
/// What a probe feels after it was pushed through the middle of a tube, a sheet or a branching body.
#pragma once
#include "soft_body.hpp"

namespace hapticd {

/// [rt] Returns the felt surface. Its outward direction turns toward the direction of the foot, by a bounded angle per
/// metre that the probe moves aside. So a probe that was pushed straight through the middle is still pushed back to
/// where it came from. Beyond the middle, the depth is measured along this direction to the sphere of the foot. If the
/// probe crosses a sheet, the direction turns only at the sheet's rim.
/// @param fades true if a probe that leaves on the far side loses its force gradually, over a path of one radius, and
/// not in one tick. Then also, away from the middle, the direction is that of the foot at once, on either flank of a
/// valley
Felt feltTurning(const Eigen::Vector3d& p, const Eigen::Vector3d& moved, bool fades, Track& track) noexcept HSP_RT;

/// [rt] Returns the felt surface of a sheet from a grid. In the interior of the sheet, the direction is that of the
/// foot, on the side from which the probe came. Round the rim it turns by a bounded angle per metre that the probe
/// moves aside; after the probe comes back from the rim, per metre that the probe moves in any direction. A probe that
/// does not move feels a constant force everywhere.
/// @param fades see feltTurning()
Felt feltOnSheet(const Eigen::Vector3d& p, const Eigen::Vector3d& moved, bool fades, Track& track) noexcept HSP_RT;

}  // namespace hapticd
