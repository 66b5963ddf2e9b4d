// SPDX-License-Identifier: MIT
/// Finds real arms that push less than their limits allow. The daemon reduces their force because a command may stay in
/// effect for a long time after a fault. Only the files are read, and no arm is opened.
#pragma once
#include <string>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

inline constexpr double kFastServo = 1e4;  ///< [Hz] servo rate to assume without a scene

/// [main] Returns the rate [Hz] of an arm's samples from its file; 0 if only the opened arm has this fact.
double namedRate(const scene::Device& device);

/// [main] Returns why an arm pushes less than its limits allow at this rate of the servo [Hz], and what to do. Returns
/// "" if it does not push less. Simulated arms never do.
std::string slownessOf(const scene::Device& device, double servo_rate);

/// [main] Returns a warning with that text for each such arm of a scene.
document::Problems slowArms(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
