// SPDX-License-Identifier: MIT
/// Judges whether the motors of a device file can be those of its arm. If units or gears are wrong, the computed heat
/// of the motors is wrong too.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of motors whose windings would get far too hot, or not at all warm, at arm.max_torque.
void warnOfMotors(const document::Node& root, const scene::Device& device, size_t joints, document::Problems& warnings);

}  // namespace hapticd::diagnostics
