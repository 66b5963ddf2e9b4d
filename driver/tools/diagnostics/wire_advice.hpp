// SPDX-License-Identifier: MIT
/// What is allowed in a wire format, but is rarely meant.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of torques whose scale does not fit arm.max_torque: too small a range, or a step so coarse that no
/// force is felt; and of a byte between two joints' positions that no field has.
/// @param device as loaded without a problem @param root of its file
void adviseWire(const document::Node& root, const scene::Device& device, size_t joints, document::Problems& warnings);

}  // namespace hapticd::diagnostics
