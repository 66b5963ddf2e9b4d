// SPDX-License-Identifier: MIT
/// Finds real arms that push less than their limits allow, because a command may stay on for long after a fault. Only
/// the files are read; no arm is opened.
#pragma once
#include <string>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

inline constexpr double kFastServo = 1e4;  ///< [Hz] servo rate to assume without a scene

/// [main] [Hz] Returns the rate of an arm's samples as its file gives it; 0 if only the opened arm could tell it.
double namedRate(const scene::Device& device);

/// [main] Returns why an arm pushes less than its limits allow at this rate of the servo [Hz], and what to do; "" if it
/// does not push less, as all simulated arms.
std::string slownessOf(const scene::Device& device, double servo_rate);

/// [main] Returns a warning with that text for each such arm of a scene.
document::Problems slowArms(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
