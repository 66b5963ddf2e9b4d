// SPDX-License-Identifier: MIT
/// Finds the pose in which an arm rests, from its file.
#pragma once
#include <array>
#include <cstdint>

#include "document/node.hpp"
#include "hapticd/device.h"

namespace hapticd::diagnostics {

using Joints = std::array<double, HDV_MAX_JOINTS>;  ///< [rad]

/// [main] Returns the joint positions of the arm at rest [rad]: its calibration pose. Without a calibration pose, each
/// joint is at zero, or at the stop nearest to zero.
Joints restJoints(const document::Node& root, uint32_t joints);

/// [main] Moves joints between their stops: those of a simulated chain to the middle, where it begins, and others to
/// the nearest stop if they are beyond it.
void keepWithinStops(const document::Node& root, Joints& q, uint32_t joints);

}  // namespace hapticd::diagnostics
