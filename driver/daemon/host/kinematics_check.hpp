// SPDX-License-Identifier: MIT
/// Whether the kinematics of a device module agree with themselves. The torques of a force are J^T F: where J is not
/// the derivative of the tip's position, a wall may draw the hand in.
#pragma once
#include <string>
#include <vector>

#include "hapticd/device.h"

namespace hapticd::host {

/// [main] Compares the Jacobian with differences of forward() at a fixed set of joint positions, each within a radian
/// (or a metre) of zero. Positions that forward() refuses, or where it is not smooth, are left out. The angular rows
/// are judged only where the module gives any.
/// @return what is wrong, for one message; empty: nothing was found
std::string wrongJacobian(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] All for which no arm may get a force, as far as it is known before the arm is open: a joint count that cannot
/// be, a function that is missing, one that answers nowhere or with no number, an orientation without length, a tip
/// farther away than any arm reaches, a function that writes beyond its room, and a wrong Jacobian.
/// @return as wrongJacobian()
std::string wrongKinematics(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] The same between the stops of an arm that is open, where a run will call them: there every answer must be a
/// number, and some place must have one.
std::string wrongBetweenStops(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info);

/// [main] An inverse() that does not lead back to the tip, or leads where no arm reaches: no run faults on it, but
/// simulated hands and `device encode` go wrong by it. @return as wrongJacobian()
std::string wrongInverse(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] What makes no run fault, and yet is hardly meant: joints that turn the tip and have no angular rows, a tip
/// farther away than a hand leads it.
std::vector<std::string> doubtsAboutKinematics(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] Joints whose motors cannot carry the arm's own weight at any place between its stops; "": none is known.
std::string weightBeyondMotors(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info);

}  // namespace hapticd::host
