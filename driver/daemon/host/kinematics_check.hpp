// SPDX-License-Identifier: MIT
/// Checks that the kinematic functions of a device module agree with each other. The joint torques of a force F are
/// J^T F. If J is not the derivative of the tip's position, a wall may pull the hand in.
#pragma once
#include <string>
#include <vector>

#include "hapticd/device.h"

namespace hapticd::host {

/// [main] Compares the Jacobian with differences of forward() at a fixed set of joint positions, each within a radian
/// (or a metre) of zero. It skips positions that forward() refuses, or at which forward() is not smooth. It checks the
/// angular rows only if they are not all zero.
/// @return what is wrong, for one message; "" if nothing was found
std::string wrongJacobian(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] Finds problems that make forces dangerous, and that can be found before the arm is open: an impossible joint
/// count, a missing function, a function that refuses all positions or gives numbers that are not finite, an
/// orientation that is not a unit quaternion, a tip farther away than any arm reaches, a function that writes more
/// numbers than it may, and a wrong Jacobian. @return as wrongJacobian()
std::string wrongKinematics(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] Checks the answers of the functions at places between the stops of an open arm, where a run will call them.
/// Here every answer must be finite, and forward() and jacobian() must accept at least one place. @return as
/// wrongJacobian()
std::string wrongBetweenStops(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info);

/// [main] Finds an inverse() whose joints do not give the same tip again, or that accepts a tip which no arm reaches. A
/// wrong inverse() causes no fault in a run, but simulated hands and `device encode` need a correct one. @return as
/// wrongJacobian()
std::string wrongInverse(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] Finds things that cause no fault in a run but are probably mistakes: joints that turn the tip although the
/// angular rows are zero, a tip farther away than a hand can move it, places with results that are not finite, or
/// gravity torques that pull the arm down. @return one text for each
std::vector<std::string> doubtsAboutKinematics(const hdv_ext_kinematics& kinematics, const hdv_device* device);

/// [main] Finds a joint whose motor cannot carry the arm's own weight at any place between its stops. @return what is
/// wrong, for one message; "" if there is no such joint
std::string weightBeyondMotors(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info);

/// [main] Finds an arm that is too heavy for its motors at half or more of all places and mountings: probably its
/// masses are in wrong units. @return as weightBeyondMotors()
std::string heavyForMotors(const hdv_ext_kinematics& kinematics, const hdv_device* device, const hdv_info& info);

}  // namespace hapticd::host
