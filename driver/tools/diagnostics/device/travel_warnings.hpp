// SPDX-License-Identifier: MIT
/// Compares the range of positions that a report can express (raw numbers times scale) with the range that the arm has.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of positions whose type cannot express all of `arm.limits`, and of a `limits.workspace` that is far
/// larger than the region that these positions let the tip reach. In both cases the scale is too small or the type too
/// narrow. @param arm is nullptr if the file has mistakes, so that only single fields are judged
void warnOfTravel(const document::Node& root, const scene::Device& device, size_t joints,
                  const host::DeviceInstance* arm, document::Problems& warnings);

}  // namespace hapticd::diagnostics
