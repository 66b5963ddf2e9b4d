// SPDX-License-Identifier: MIT
/// Finds how far an arm can move its tip.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "description/scene.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Returns how far [m] the joints can move the tip from `tip_device` (device frame) within arm.limits. Without
/// arm.limits the result is an overestimate.
double reachOf(const scene::Device& device, const host::DeviceInstance& arm, const Eigen::Vector3d& tip_device);

/// [main] Returns the box [m] (device frame) round all places of the tip within the joint limits; nothing if some joint
/// has no limits. @param arm an opened arm
std::optional<Eigen::AlignedBox3d> boxOfReach(const host::DeviceInstance& arm);

}  // namespace hapticd::diagnostics
