// SPDX-License-Identifier: MIT
/// Finds settings of a scene's servo and arms that were hardly meant: gravity that points up, a search radius of 100 m,
/// two arms in one place.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/model_trial.hpp"
#include "document/problem.hpp"
#include "hapticd/device.h"

namespace hapticd::diagnostics {

/// [main] Warns of gravity, search radii and budgets that are not usual, and of arms that stand in one another.
/// @param boxes as tryModels() found them
document::Problems implausibleSettings(const scene::Scene& scene, const ModelBoxes& boxes = {});

/// [main] Judges models that lie in the same place by tune::unstableSettings() with the sum of their stiffness, because
/// a hand feels them together. @param info what the arm says about itself  @param stiffness [N/m] stiffness that each
/// model claims, in scene order
document::Problems stiffTogether(const scene::Scene& scene, const scene::Device& device, const hdv_info& info,
                                 const std::vector<double>& stiffness);

/// [main] Warns of a virtual mass (admittance.mass) so small that an arm with the felt mass in `info` cannot follow it.
document::Problems lightAdmittance(const scene::Scene& scene, const scene::Device& device, const hdv_info& info);

}  // namespace hapticd::diagnostics
