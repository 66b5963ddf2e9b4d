// SPDX-License-Identifier: MIT
/// Finds settings that cannot be stable on a device at this rate, before any force.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "hapticd/device.h"

namespace hapticd::tune {

/// [main] Warns of a stiffness above the device's max_stiffness, or above what its felt mass allows without damping at
/// this rate and with this window of the velocity estimator (Colgate & Schenkel 1997 give the bound with damping).
/// Warns also of a force step of one encoder count that a hand feels as buzz, of a budget longer than the period, of a
/// rate that is not the device's own, of a device that should drive the loop but cannot, and of a force that the arm
/// cannot sustain if no model of its motors' heat limits it. Each warning names the bound and the nearest setting that
/// keeps it.
/// @param info what the arm said about itself when it was opened @param stiffness [N/m] stiffness that each model
/// claims, in scene order
document::Problems unstableSettings(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                                    const std::vector<double>& stiffness);

/// [main] Warns of kinematic paths that are faster than `ctl move` may move a model, because such a path does not yield
/// to a hand in its way. Each warning names the model, the fastest piece of its path and the bound.
document::Problems fastPaths(const scene::Scene& scene);

/// [main] Returns a sentence for the user if an arm was asked for more force than it sustains, or "".
/// @param sustained [N] force that the arm sustains for any length of time; 0 if unknown @param forces [N] forces of
/// successive ticks; their mean square heats the motors @param rate [Hz] rate of these ticks
std::string overheating(const std::string& device, double sustained, const std::vector<double>& forces, double rate);

}  // namespace hapticd::tune
