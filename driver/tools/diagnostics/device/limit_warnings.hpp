// SPDX-License-Identifier: MIT
/// Compares the limits of a device file with what its arm and its motors can give.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of `limits.force` and `device.max_force` beyond what arm.max_torque gives at rest in the arm's
/// strongest direction, of `limits.force` beyond `device.max_force`, and of `limits.torque` beyond the motors.
void warnOfLimits(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                  document::Problems& warnings);

}  // namespace hapticd::diagnostics
