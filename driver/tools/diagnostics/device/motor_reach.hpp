// SPDX-License-Identifier: MIT
/// The largest force and torque at the tip that an arm's motors can make together.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hapticd::diagnostics {

/// [any] Returns the largest |x| for which |J^T x| is at most `torque` in each joint. It is reached at a corner of the
/// polytope of all such x.
/// @param jacobian 3 rows (for the velocity of the tip, or for its angular velocity), one column per joint
/// @param torque [N m] greatest torque of each motor at its joint
/// @return [N] or [N m]; nothing if the mechanism carries the load in some direction, so that the motors do not limit
/// it
std::optional<double> farthestReach(const Eigen::Matrix3Xd& jacobian, const std::vector<double>& torque);

}  // namespace hapticd::diagnostics
