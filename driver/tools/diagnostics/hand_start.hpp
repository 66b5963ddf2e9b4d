// SPDX-License-Identifier: MIT
/// Where the tip of each arm is when a run begins: within its reach, and not within a model, or the hand is pushed at
/// once.
#pragma once
#include <filesystem>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of each model that the tip of an arm is in at the first tick, with the depth, and of each arm that can
/// reach none of the models. Simulated hands stand where their script begins, other arms in the pose of their
/// calibration. Where nothing of that is wrong and all arms are simulated, their hands walk through the scene: see
/// walk_advice.hpp. The models are set up in a child process.
/// @param scene with the devices that a run would take
document::Problems adviseHands(const scene::Scene& scene);

/// [main] A problem for each simulated arm that `run` would refuse, in its words: one that cannot reach where its hand
/// begins, an enable button that it has not. The arms are started in a child process.
/// @param scene with the devices that a run would take  @param needs_velocity some model reads the velocity of a probe
document::Problems refusedArms(const scene::Scene& scene, bool needs_velocity);

/// [main] The same for one device file. Without a hand of its own it waits for that of a scene, which is not judged.
/// @param warnings get what hastyHands() says of its hand
document::Problems refusedAlone(const std::filesystem::path& file, host::Catalog& catalog,
                                document::Problems& warnings);

}  // namespace hapticd::diagnostics
