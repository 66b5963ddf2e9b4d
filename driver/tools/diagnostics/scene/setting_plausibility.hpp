// SPDX-License-Identifier: MIT
/// Finds settings of a scene's servo and arms that were hardly meant: gravity that points up, a search radius of 100 m,
/// two arms in one place.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "document/problem.hpp"
#include "hapticd/device.h"

namespace hapticd::diagnostics {

/// [main] Warns of gravity, search radii and budgets that are not usual, and of arms that stand in the same place.
/// @param boxes boxes of the models from tryModels()
document::Problems implausibleSettings(const scene::Scene& scene, const ModelBoxes& boxes = {});

/// [main] Adds up the stiffness of models that lie in the same place, because a hand feels them together, and judges
/// the sum by tune::unstableSettings().
/// @param info the facts that the module gave when the arm was opened
/// @param stiffness [N/m] stiffness that each model claims, in scene order
document::Problems stiffTogether(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                                 const std::vector<double>& stiffness);

/// [main] Warns of a virtual mass (admittance.mass) so small that an arm with the felt mass in `info` cannot follow it.
document::Problems lightAdmittance(const scene::Scene& scene, const scene::Device& device, const hdv_info& info);

}  // namespace hapticd::diagnostics
