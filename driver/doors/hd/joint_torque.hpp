// SPDX-License-Identifier: MIT
/// From torques of joints, as some programs set them, to the force and the torque on the hand that hapticd knows.
#pragma once
#include <vector>

#include "facts.hpp"
#include "hapticd/client.h"

namespace hapticd::hd {

/// The wrench whose joint torques J^T W come nearest to those asked for: of all six joints where the arm has them and a
/// gimbal with motors, otherwise the force of the first three. Near a singular pose it stays bounded (damped least
/// squares, Nakamura and Hanafusa 1986).
/// @param torque [N m] of turret, thigh and shin, then of the gimbal @param force [N] @param moment [N m] world frame
void wrenchOf(const Facts& facts, const hapticd_jacobian& jacobian, const double torque[6], double force[3],
              double moment[3]);

}  // namespace hapticd::hd
