// SPDX-License-Identifier: MIT
/// What of a scene's servo and arms nobody can mean: gravity that points up, a search radius of 100 m, two arms in one
/// place.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/model_trial.hpp"
#include "document/problem.hpp"
#include "hapticd/device.h"

namespace hapticd::diagnostics {

/// [main] Warns of gravity, search radii and budgets that are not usual, and of arms that stand in one another.
/// @param boxes as tryModels() found them
document::Problems unusualSettings(const scene::Scene& scene, const ModelBoxes& boxes = {});

/// [main] What models that lie in one place do together to an arm: tune::unstableSettings() with the sum of their
/// stiffness. @param info what the arm says of itself  @param stiffness [N/m] that each model claims, in scene order
document::Problems stiffTogether(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                                 const std::vector<double>& stiffness);

/// [main] Warns of a virtual mass that an arm of the felt mass of `info` cannot follow.
document::Problems lightAdmittance(const scene::Scene& scene, const scene::Device& device, const hdv_info& info);

}  // namespace hapticd::diagnostics
