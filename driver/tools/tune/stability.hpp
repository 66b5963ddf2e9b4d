// SPDX-License-Identifier: MIT
/// Settings that cannot be stable on a device at a rate, found before any force.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "hapticd/device.h"

namespace hapticd::tune {

/// [main] What to warn of: a stiffness beyond what the device was found to bear, or beyond what its mass bears by
/// itself at this rate and with this window of the velocity estimator (Colgate & Schenkel 1997 give the bound with
/// damping); a force step of one count that a hand feels as buzz; a budget beyond the period; a rate that is not the
/// device's own; a device that should drive the loop but cannot; a force that the arm cannot sustain and that no model
/// of its motors' heat ends. Each names the bound and the nearest setting that keeps it.
/// @param device the arm, with what it said of itself when opened
/// @param stiffness [N/m] that each model claims, in scene order
document::Problems unstableSettings(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                                    const std::vector<double>& stiffness);

/// [main] Kinematic paths faster than a person may order a model to move: such a path goes through a hand that is in
/// its way as fast, and does not yield. Each names the path's model, the fastest piece and the bound.
document::Problems fastPaths(const scene::Scene& scene);

/// [main] Whether an arm was asked for more force than it sustains: "", or what a user should know.
/// @param sustained [N] for any length of time; 0: unknown
/// @param forces [N] of successive ticks; motors heat with the square of them  @param rate [Hz] of those ticks
std::string overheating(const std::string& device, double sustained, const std::vector<double>& forces, double rate);

}  // namespace hapticd::tune
