// SPDX-License-Identifier: MIT
/// Warns of entries in a wire format that are allowed but were hardly meant.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of torques whose scale does not fit arm.max_torque (too small a range, or steps so coarse that no force
/// is felt), of numbers that no checksum covers, of start-up bytes that command a torque, and of a byte between two
/// joints' positions that belongs to no field. @param device device that was loaded without a problem  @param root
/// content of its file
void warnOfWire(const document::Node& root, const scene::Device& device, size_t joints, document::Problems& warnings);

}  // namespace hapticd::diagnostics
