// SPDX-License-Identifier: MIT
/// The largest force and torque at the tip that an arm's motors can make together.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

namespace hapticd::diagnostics {

/// [any] The largest |x| with |J^T x| at most `torque`, joint by joint: the farthest corner of what the motors bound.
/// @param jacobian 3 rows (of the tip's velocity, or of its angular velocity), a column a joint
/// @param torque of each motor at its joint [N m]
/// @return [N] or [N m]; nothing where some direction is carried by the joints alone, so that no motor bounds it
std::optional<double> farthestReach(const Eigen::Matrix3Xd& jacobian, const std::vector<double>& torque);

}  // namespace hapticd::diagnostics
