// SPDX-License-Identifier: MIT
/// Checks where the tip of each arm is when a run begins. It must be within reach of the arm and outside every model.
/// Inside a model, a force would push the hand at once.
#pragma once
#include <filesystem>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Warns if the tip of an arm is inside a model at the first tick, with the depth, and if an arm can reach none
/// of the models. The tips of simulated arms are at the start of their script, those of other arms in the calibration
/// pose. If there is no such warning and all arms are simulated, their hands then run their scripts through the scene
/// (see walk_warnings.hpp). The models are set up in a child process.
/// @param scene scene with the devices that a run would use
/// @param strays as for warnOfWalk()
/// @param all_models false if the hands may be meant for a model that is not in the scene; then no hand is said to feel
/// nothing
/// @param known false if it is known only where the hands start, and not how they move; then they do not run. A scene
/// without devices has no hands: only its models are judged
document::Problems warnOfHands(const scene::Scene& scene, const std::vector<bool>& strays = {}, bool all_models = true,
                               bool known = true);

/// [main] Returns a problem for each simulated arm that `run` would refuse, with the text of `run`: an arm that cannot
/// reach the start of its hand's motion, or that lacks the enable button. The arms are started in a child process.
/// @param scene scene with the devices that a run would use  @param needs_velocity true if some model reads the
/// velocity of a probe
document::Problems refusedArms(const scene::Scene& scene, bool needs_velocity);

/// [main] Like refusedArms(), for the arm of one device file without a scene. If the file describes no hand, only the
/// arm is checked, because each scene gives the hand.
/// @param warnings receives the warnings of fastHands() about its hand
document::Problems refusedAlone(const std::filesystem::path& file, host::Catalog& catalog,
                                document::Problems& warnings);

}  // namespace hapticd::diagnostics
