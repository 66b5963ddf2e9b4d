// SPDX-License-Identifier: MIT
/// Whether the motors of a device file can be those of its arm: units and gears that make their heat meaningless.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of motors that would make more heat at arm.max_torque than any winding bears.
void adviseMotors(const document::Node& root, const scene::Device& device, size_t joints, document::Problems& warnings);

}  // namespace hapticd::diagnostics
