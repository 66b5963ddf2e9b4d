// SPDX-License-Identifier: MIT
/// Warns of dangerous gaps and errors in a device file, before the arm gets any force.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of these: an arm whose force or torque has no limit, a joint whose position and torque have opposite
/// signs, a slow watchdog, samples so rare that the arm pushes less than its limits allow, a time without reports
/// (health.stale) that one late report exceeds, relative encoders without a calibration, a weight that the motors
/// cannot hold, keys that the kind of their field does not use, and two fields for the same button.
void warnOfSafety(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                  document::Problems& warnings);

}  // namespace hapticd::diagnostics
