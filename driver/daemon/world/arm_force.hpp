// SPDX-License-Identifier: MIT
/// What the arms of a scene let through to the hand, before any of them is opened.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "hapticd/device.h"

namespace hapticd::servo {

/// [main] The largest force [N] of any arm, by limits.force and the maximum that its device file or module names; 0 if
/// nothing is known about one of them.
double maxForceOf(const scene::Scene& scene);

/// [any] The same for a recorded run. @param devices what the arms said when they were opened
double maxForceOf(const scene::Scene& scene, const std::vector<hdv_info>& devices);

}  // namespace hapticd::servo
