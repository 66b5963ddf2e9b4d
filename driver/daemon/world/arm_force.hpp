// SPDX-License-Identifier: MIT
/// The largest force that the arms of a scene let through to the hand. It is known before an arm is opened.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "hapticd/device.h"

namespace hapticd::servo {

/// [main] Returns the largest force [N] of any arm, from limits.force and the maximum that its device file or module
/// gives; 0 if the force of one arm is unknown.
double maxForceOf(const scene::Scene& scene);

/// [any] Returns the same force for a recorded run. @param devices reports of the arms when they were opened
double maxForceOf(const scene::Scene& scene, const std::vector<hdv_info>& devices);

}  // namespace hapticd::servo
