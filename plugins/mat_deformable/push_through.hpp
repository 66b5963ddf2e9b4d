// SPDX-License-Identifier: MIT
/// What a probe feels after it was pushed through the middle of a tube, a sheet or a branching body.
#pragma once
#include "soft_body.hpp"

namespace hapticd {

/// [rt] Returns the felt surface. Its outward direction turns toward the direction of the foot (from the skeleton to
/// the probe). The angle of this turn is bounded for each metre that the probe moves aside. So a probe that was pushed
/// straight through the middle is still pushed back to the side from which it came. Beyond the middle, the depth is
/// measured along the outward direction to the sphere of the foot. If the probe crosses a sheet, the direction turns
/// only at the rim of the sheet. If the probe is not near the middle, the direction is that of the foot at once, on
/// either flank of a valley.
/// @param fades true if a probe that leaves on the far side loses its force gradually, over a path of one radius; false
/// if it loses it in one tick
Felt feltTurning(const Eigen::Vector3d& p, const Eigen::Vector3d& moved, bool fades, Track& track) noexcept HSP_RT;

/// [rt] Returns the felt surface of a sheet from a grid. In the interior of the sheet, the direction is that of the
/// foot, on the side from which the probe came. At the rim the direction turns by a bounded angle for each metre that
/// the probe moves aside. When the probe has come back from the rim, it turns by a bounded angle for each metre that
/// the probe moves in any direction. A probe that does not move feels a constant force everywhere.
/// @param fades see feltTurning()
Felt feltOnSheet(const Eigen::Vector3d& p, const Eigen::Vector3d& moved, bool fades, Track& track) noexcept HSP_RT;

}  // namespace hapticd
