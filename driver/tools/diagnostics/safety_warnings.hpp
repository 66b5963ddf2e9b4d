// SPDX-License-Identifier: MIT
/// Warns, before any force, of what a device file leaves out or reverses that a hand would feel.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of an arm whose force or torque nothing bounds, of a joint whose position and torque have opposite
/// signs, of a slow watchdog, of samples so rare that the arm pushes less, of relative encoders without a calibration,
/// of a weight that the motors cannot hold, and of keys of a report's field that this kind of field does not use.
void warnOfSafety(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                  document::Problems& warnings);

}  // namespace hapticd::diagnostics
