// SPDX-License-Identifier: MIT
/// Finds damping that turns the steps of an encoder into a tremor: a velocity estimate over a short time takes one
/// count for a fast motion.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"
#include "hapticd/device.h"

namespace hapticd::tune {

/// [main] Warns of each model whose damping or viscosity makes a large force of one encoder count, with the estimator
/// of servo.velocity at the rate of the samples; of a wall, whose damping grows with depth, where it pushes with 4 N.
/// Names the damping, and the window if the model is as stable with it, that avoids it.
/// @param info facts about the arm; its resolution and rate are used if they are known
document::Problems noisyDamping(const scene::Scene& scene, const scene::Device& device, const hdv_info& info);

}  // namespace hapticd::tune
