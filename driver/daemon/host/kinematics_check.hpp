// SPDX-License-Identifier: MIT
/// Whether the kinematics of a device module agree with themselves. The torques of a force are J^T F: where J is not
/// the derivative of the tip's position, a wall may draw the hand in.
#pragma once
#include <string>

#include "hapticd/device.h"

namespace hapticd::host {

/// [main] Compares the Jacobian with differences of forward() at a fixed set of joint positions, each within a radian
/// (or a metre) of zero. Positions that forward() refuses, or where it is not smooth, are left out. The angular rows
/// are judged only where the module gives any.
/// @return what is wrong, for one message; empty: nothing was found
std::string wrongJacobian(const hdv_ext_kinematics& kinematics, const hdv_device* device);

}  // namespace hapticd::host
