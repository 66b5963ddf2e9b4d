// SPDX-License-Identifier: MIT
/// Calculates how long one command may stay on after a fault, and how much force is safe for this time. A fault is
/// found only at the next tick or the next sample, and until then the motors keep the last command.
#pragma once
#include <string>

namespace hapticd::servo {

/// [s] A command that is held for at most this time may have the full force. In this time 8.5 N move the free tip of a
/// simulated Premium 1.5 (59 g where it is lightest) by 0.6 mm and give it 4.8 mJ.
constexpr double kHeldInFull = 2.8e-3;
/// [s] In this time 8.5 N move the same tip by 0.93 mm. The force of a command that is held for longer is reduced until
/// the tip moves no farther.
constexpr double kHeldForDistance = 3.6e-3;
/// [N] Largest force of the arm for which the times above were calculated. For a stronger arm, shareHeld() is a share
/// of its own largest force, because a stronger arm is also heavier.
constexpr double kReckonedForce = 8.5;

/// [any] Returns how long [s] a command may stay on after a single fault: until the next tick, or until a sample shows
/// the fault and the arm has taken the next command. @param arm_rate [Hz] reported by the arm, 0: unknown
double longestHeld(double servo_rate, double arm_rate);

/// [any] Returns the share of the full force that a command may have if it is held for `held` [s], so that a free arm
/// gets at most 5 mJ and moves by at most 1 mm.
double shareHeld(double held);

/// [any] Returns the largest force [N] of a real arm at these rates [Hz]; infinite if the full force is safe.
/// @param device_force [N] the arm's own maximum, 0: unknown
double mostForceAt(double servo_rate, double arm_rate, double device_force);

/// [any] Returns why a low rate makes an arm push less than its limits allow, and the cure; "" if the arm may push with
/// its full force.
/// @param asked [N] force limit without this bound, 0: unknown
std::string describeSlow(double servo_rate, double arm_rate, double device_force, double asked);

}  // namespace hapticd::servo
