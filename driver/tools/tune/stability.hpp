// SPDX-License-Identifier: MIT
/// Finds settings of a scene with which a device cannot be stable. Works without moving the arm.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "hapticd/device.h"

namespace hapticd::tune {

/// [main] Warns of these settings:
///   - a stiffness above max_stiffness of the device, or above what the felt mass of the arm allows without damping at
///     this rate of the servo and with this window of the velocity estimator (Colgate & Schenkel 1997 give the bound
///     with damping),
///   - a damping that grows with depth beyond what arm and hand allow at this rate,
///   - a force step of one encoder count that a hand feels as buzz,
///   - a budget longer than the period,
///   - a rate of the servo that differs from that of the device, and a device that should pace the servo but cannot,
///   - a force that the arm cannot sustain, if no model of its motors' heat limits it.
/// Each warning names the bound and the nearest setting that keeps it.
/// @param info the facts that the module gave when the arm was opened
/// @param stiffness [N/m] stiffness that each model claims, in scene order
document::Problems unstableSettings(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                                    const std::vector<double>& stiffness);

/// [main] Warns of kinematic paths that are faster than `ctl move` may move a model. A model on such a path does not
/// stop for a hand in its way. Each warning names the model, the fastest piece of its path and the bound.
document::Problems fastPaths(const scene::Scene& scene);

/// [main] Returns a sentence for the user if an arm was asked for more force than it sustains, or "".
/// @param sustained [N] force that the arm sustains for any length of time; 0 if unknown @param forces [N] forces of
/// successive ticks; their mean square heats the motors @param rate [Hz] rate of these ticks @param pusher program
/// whose force this was, because no model was touched; "" if models gave it
std::string overheating(const std::string& device, double sustained, const std::vector<double>& forces, double rate,
                        const std::string& pusher = "");

}  // namespace hapticd::tune
