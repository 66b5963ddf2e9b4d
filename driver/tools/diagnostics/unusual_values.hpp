// SPDX-License-Identifier: MIT
/// Values of models that their plugins take and that nobody can mean: millimetres, degrees, grams, a sign.
#pragma once
#include "description/scene.hpp"
#include "diagnostics/model_trial.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

class GivenModel;

/// [main] Warns of each parameter that is beyond what is usual for a quantity of its unit, of bodies that fall or hang
/// far from their place, and of models that lie in one another.
/// @param boxes as tryModels() found them, or none: then nothing is held against the models' sizes
document::Problems unusualValues(const scene::Scene& scene, const ModelBoxes& boxes, host::Catalog& catalog);

/// Those of each parameter by itself, by the unit that its plugin says of it.
void judgeQuantities(const GivenModel& given);

/// Those of a body that moves by its weight and the forces on it.
void judgeBody(const GivenModel& given);

/// [main] Models that lie in one place as copies do whose pose was forgotten, and the groups that they make: indices,
/// each group in scene order.
std::vector<std::vector<size_t>> modelsInOnePlace(const scene::Scene& scene);
document::Problems tellModelsInOnePlace(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
