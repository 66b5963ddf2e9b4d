// SPDX-License-Identifier: MIT
/// Converts joint torques, which some HDAPI programs set, to a force and a torque at the tip, which hapticd takes.
#pragma once

#include "facts.hpp"
#include "hapticd/client.h"

namespace hapticd::hd {

/// Computes the wrench W whose joint torques J^T W are nearest to the given torques. For an arm with six joints and
/// motors in its gimbal it uses all six joints; for other arms it computes only the force, from the first three joints.
/// Near a singular pose the wrench stays bounded (damped least squares, Nakamura and Hanafusa 1986).
/// @param torque [N m] of turret, thigh and shin, then of the gimbal @param force [N] @param moment [N m] world frame
void wrenchOf(const DeviceFacts& facts, const hapticd_jacobian& jacobian, const double torque[6], double force[3],
              double moment[3]);

}  // namespace hapticd::hd
