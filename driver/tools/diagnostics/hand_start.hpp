// SPDX-License-Identifier: MIT
/// Where the tip of each arm is when a run begins: within its reach, and not within a model, or the hand is pushed at
/// once.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of each model that the tip of an arm is in at the first tick, with the depth, and of each arm that can
/// reach none of the models. Simulated hands stand where their script begins, other arms in the pose of their
/// calibration. The models are set up in a child process.
/// @param scene with the devices that a run would take
document::Problems adviseHands(const scene::Scene& scene);

/// [main] A problem for each simulated arm that cannot reach where its hand begins, in the module's words: `run` would
/// refuse it. The arms are started in a child process.
/// @param scene with the devices that a run would take
document::Problems unreachableHands(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
