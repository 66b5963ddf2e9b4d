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

/// [main] Problems that forbid forces, as far as they are known before the arm is open: an impossible joint count, a
/// function that is missing, one that answers nowhere or with no number, an orientation without length, a tip farther
/// away than any arm reaches, a function that writes beyond its room, and a wrong Jacobian.
/// @return as wrongJacobian()
std::string wrongKinematics(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] The same between the stops of an open arm, where a run will call the functions: there every answer must be a
/// number, and at least one place must have an answer.
std::string wrongBetweenStops(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info);

/// [main] An inverse() that does not lead back to the tip, or leads where no arm reaches. It causes no fault in a run,
/// but simulated hands and `device encode` go wrong because of it. @return as wrongJacobian()
std::string wrongInverse(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] What causes no fault in a run, but is hardly intended: joints that turn the tip without angular rows, a
/// tip farther away than a hand moves it, places without numbers, or torques that pull the arm down with its weight.
std::vector<std::string> doubtsAboutKinematics(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] Joints whose motors cannot carry the arm's own weight at any place between its stops; "" if there are none.
std::string weightBeyondMotors(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info);

/// [main] The same at half of all places and mountings: masses in other units. "" if there is nothing to tell.
std::string heavyForMotors(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info);

}  // namespace hapticd::host
