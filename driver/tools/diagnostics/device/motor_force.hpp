// SPDX-License-Identifier: MIT
/// Finds the force that the motors of an arm give at its tip.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/device/rest_joints.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Returns arm.max_torque of each joint [N m]; empty if it is not known for all joints.
std::vector<double> motorsOf(const scene::Device& device, size_t joints);

/// [main] [N] Returns the force that the motors give at rest in the arm's strongest direction; nothing if it is
/// unknown.
std::optional<double> forceOfMotors(const document::Node& root, const scene::Device& device,
                                    const host::DeviceInstance& arm);

/// The largest force of the motors at the tip [N], and where it holds: at rest, or, if the arm rests stretched out, the
/// median over some poses. The links of a stretched arm bear any force along the arm, so its motors bound nothing
/// there.
struct MotorForce {
  double most = 0;
  const char* where = "at rest";
};

/// [main] Returns that force; nothing if it is unknown.
std::optional<MotorForce> motorForce(const document::Node& root, const scene::Device& device,
                                     const host::DeviceInstance& arm);

/// [main] Returns three rows of the Jacobian in one pose, from `first` on; nothing if the module cannot calculate it.
std::optional<Eigen::Matrix3Xd> jacobianAt(const Joints& q, const host::DeviceInstance& arm, Eigen::Index first);

}  // namespace hapticd::diagnostics
