// SPDX-License-Identifier: MIT
/// The way that counts times scale give, against the way that the arm has.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of positions whose numbers end before `arm.limits` do, and of a `limits.workspace` that is far larger
/// than what they can bring the tip through: their scale is too small, or their type too narrow.
void adviseTravel(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                  document::Problems& warnings);

}  // namespace hapticd::diagnostics
