// SPDX-License-Identifier: MIT
/// How long one command may stay on after a fault, and what that leaves of the force limit: the next tick, or the next
/// sample, is what finds the fault, and until then the motors do as they were told.
#pragma once
#include <string>

namespace hapticd::servo {

/// [s] A command that is held for at most this time may have the full force: 8.5 N give the free tip of a simulated
/// Premium 1.5, which has 59 g where it is lightest, 4.8 mJ and move it by 0.6 mm.
constexpr double kHeldInFull = 2.8e-3;
/// [s] In this time 8.5 N move it by 0.93 mm, which bounds the force of a command that is held for longer.
constexpr double kHeldForWay = 3.6e-3;
/// [N] of the arm for which that was calculated. A stronger arm is heavier.
constexpr double kReckonedForce = 8.5;

/// [any] [s] How long a command may stay on after a single fault: until the next tick, or until a sample shows the
/// fault and the arm has taken the next command. @param arm_rate [Hz] that the arm names, 0: unknown
double longestHeld(double servo_rate, double arm_rate);

/// [any] The share of a full force that a command held for so long may have: at most 5 mJ and 1 mm result from it.
double shareHeld(double held);

/// [any] The largest force [N] of a real arm at these rates; infinite if they are fast enough for its full force.
/// @param device_force [N] the arm's own maximum, 0: unknown
double mostForceAt(double servo_rate, double arm_rate, double device_force);

/// [any] Why an arm pushes less than its limits allow, and the cure; "" if it does not.
/// @param asked [N] its force limit otherwise, 0: unknown
std::string describeSlow(double servo_rate, double arm_rate, double device_force, double asked);

}  // namespace hapticd::servo
