// SPDX-License-Identifier: MIT
/// What a device file leaves out or turns round that a hand would feel: told before any force.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of an arm without any bound of its force, or of its torque, of a joint whose position and torque have
/// opposite signs, of a watchdog that is slow, of samples that come so rarely that the arm pushes less, of relative
/// encoders without a calibration, of a weight beyond the motors, and of keys of a report's field that what it is does
/// not use.
void adviseSafety(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                  document::Problems& warnings);

}  // namespace hapticd::diagnostics
