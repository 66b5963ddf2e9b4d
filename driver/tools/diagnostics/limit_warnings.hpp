// SPDX-License-Identifier: MIT
/// Compares the limits of a device file with what its arm and its motors can give.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the joint positions of the arm at rest [rad]: its calibration pose. Without a calibration pose, each
/// joint is at zero, or at the stop nearest to zero.
std::array<double, HDV_MAX_JOINTS> restJoints(const document::Node& root, uint32_t joints);

/// [main] Returns arm.max_torque of each joint [N m]; empty if it is not known for all joints.
std::vector<double> motorsOf(const scene::Device& device, size_t joints);

/// [main] [N] Returns the force that the motors give at rest in the arm's strongest direction; nothing if it is
/// unknown.
std::optional<double> forceOfMotors(const document::Node& root, const scene::Device& device,
                                    const host::DeviceInstance& arm);

/// [main] Warns of `limits.force` and `device.max_force` beyond what arm.max_torque gives at rest in the arm's
/// strongest direction, of `limits.force` beyond `device.max_force`, and of `limits.torque` beyond the motors.
void warnOfLimits(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                  document::Problems& warnings);

}  // namespace hapticd::diagnostics
