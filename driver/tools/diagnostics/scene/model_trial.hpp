// SPDX-License-Identifier: MIT
/// Sets up the models of a scene, to find problems that only their plugins can find, such as an error in a geometry
/// file.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// The box around each model in its own frame, in scene order; nothing if its plugin does not report a box.
using ModelBoxes = std::vector<std::optional<Eigen::AlignedBox3d>>;

/// The problems that plugins found in a scene's models, and the facts that they gave about the models.
struct ModelTrial {
  document::Problems problems, warnings;
  std::vector<double> stiffness;  ///< [N/m] that each model claims, in scene order
  std::vector<bool> moves;        ///< true for each model that its plugin moves, in scene order
  bool needs_velocity = false;    ///< some model reads the velocity of a probe
  ModelBoxes boxes;
};

constexpr double kSetupSeconds = 120;  ///< [s] most time of one call of a plugin, if nothing else is asked

/// [main] Creates and activates every model in a child process, one after the other, and collects the objections of the
/// plugins. A crash or a hang becomes a problem too.
/// @param max_force [N] largest force that any arm of the run lets through to the hand (servo::maxForceOf); 0 if
/// unknown
/// @param unsound true for each model that is left out because it has problems already; its stiffness counts as 0
/// @param setup_seconds [s] a call that takes longer is a problem. Time in which it waits for a processor does not
/// count
ModelTrial tryModels(const scene::Scene& scene, double max_force, const std::vector<bool>& unsound = {},
                     double setup_seconds = kSetupSeconds);

}  // namespace hapticd::diagnostics
