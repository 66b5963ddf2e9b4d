// SPDX-License-Identifier: MIT
/// What a probe feels that was pushed through the middle of a tube, a sheet or a branching body.
#pragma once
#include "soft_body.hpp"

namespace hapticd {

/// [rt] The outward direction turns to that of the foot by a bounded angle for each metre that the probe moves aside,
/// so that a probe that was pushed straight through the middle is still pushed back to where it came from. Depth beyond
/// the middle is measured along that direction to the sphere of the foot. Across a sheet, the direction does not turn
/// at all, but at its rim.
/// @param fades a probe that leaves on the far side loses its force over a radius of way, not in a tick; and away
/// from the middle the direction is that of the foot at once, on whichever flank of a valley it is
Felt feltTurning(const Eigen::Vector3d& p, const Eigen::Vector3d& moved, bool fades, Track& track) noexcept HSP_RT;

/// [rt] The same on a sheet from a grid. Within it, the direction is that of the foot on the side that the probe came
/// from; round the rim it turns by a bounded angle for each metre that the probe moves aside, and when it comes back
/// from there, for each metre that the probe moves. A probe that does not move feels a constant force, wherever it is.
/// @param fades likewise
Felt feltOnSheet(const Eigen::Vector3d& p, const Eigen::Vector3d& moved, bool fades, Track& track) noexcept HSP_RT;

}  // namespace hapticd
