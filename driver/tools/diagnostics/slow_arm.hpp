// SPDX-License-Identifier: MIT
/// Real arms that push less than their limits say, because a command may stay on for long after a fault: told from the
/// files alone, before an arm is opened.
#pragma once
#include <string>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

inline constexpr double kFastServo = 1e4;  ///< [Hz] used if an arm is judged without a scene

/// [main] [Hz] of the samples of an arm that is not opened, by its file; 0: only the arm itself says it.
double namedRate(const scene::Device& device);

/// [main] Why an arm pushes less at a rate of the servo [Hz], and the cure; "" if it does not, as for simulated arms.
std::string slownessOf(const scene::Device& device, double servo_rate);

/// [main] The same, as a warning for each arm of a scene.
document::Problems slowArms(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
