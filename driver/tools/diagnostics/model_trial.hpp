// SPDX-License-Identifier: MIT
/// Trying a scene's models: what only a plugin can judge, such as the content of a geometry file.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// What plugins say about a scene's models.
struct ModelTrial {
  document::Problems problems, warnings;
  std::vector<double> stiffness;  ///< [N/m] that each model claims, in scene order
};

/// [main] Creates and activates every model in a child process, one after the other, and collects what the plugins
/// object to. A crash or a hang becomes a problem too.
/// @param max_force [N] that any arm of the run lets through to the hand (servo::maxForceOf); 0: unknown
/// @param unsound models that are left out, by number: what is known of them is wrong; their stiffness counts as 0
ModelTrial tryModels(const scene::Scene& scene, double max_force, const std::vector<bool>& unsound = {});

}  // namespace hapticd::diagnostics
