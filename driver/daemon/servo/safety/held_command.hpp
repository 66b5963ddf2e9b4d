// SPDX-License-Identifier: MIT
/// How long one command may stay on after a fault, and what that leaves of the force limit: the next tick, or the next
/// sample, is what finds the fault, and until then the motors do as they were told.
#pragma once
#include <string>

namespace hapticd::servo {

/// [s] A command that is held no longer may have the full force: 8.5 N give the free tip of a simulated Premium 1.5,
/// which is 59 g where it is lightest, 4.8 mJ and move it by 0.6 mm.
constexpr double kHeldInFull = 2.8e-3;
/// [s] In so long 8.5 N move it by 0.93 mm: what bounds the force where a command is held for longer.
constexpr double kHeldForWay = 3.6e-3;
/// [N] of the arm for which that was reckoned. A stronger arm is heavier.
constexpr double kReckonedForce = 8.5;

/// [any] [s] How long a command may stay on after a single fault: until the next tick, or until a sample has come that
/// shows the fault and the arm has taken the command that follows. @param arm_rate [Hz] that it names, 0: unknown
double longestHeld(double servo_rate, double arm_rate);

/// [any] The share of a full force with which a command may be held so long: at most 5 mJ and 1 mm come of it.
double shareHeld(double held);

/// [any] The largest force [N] of a real arm at these rates; infinite where it is fast enough for all of it.
/// @param device_force [N] the arm's own maximum, 0: unknown
double mostForceAt(double servo_rate, double arm_rate, double device_force);

/// [any] Why an arm pushes less than its limits say, and the cure; "": it does not.
/// @param asked [N] its force limit otherwise, 0: unknown
std::string describeSlow(double servo_rate, double arm_rate, double device_force, double asked);

}  // namespace hapticd::servo
