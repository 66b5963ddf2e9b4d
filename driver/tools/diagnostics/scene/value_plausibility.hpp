// SPDX-License-Identifier: MIT
/// Finds values of models that their plugins accept but that were hardly meant: millimetres, degrees, grams, a wrong
/// sign.
#pragma once
#include "description/scene.hpp"
#include "diagnostics/reading/unread_keys.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

class GivenModel;

/// [main] Warns of each parameter that is beyond the usual range of a quantity of its unit, of bodies that fall or hang
/// far from their place, and of models that lie in the same place.
/// @param boxes boxes of the models from tryModels(); if empty, no value is compared with the sizes of the models
/// @param unread keys that could not be read; no warning depends on them
document::Problems implausibleValues(const scene::Scene& scene, const ModelBoxes& boxes, host::Catalog& catalog,
                                     const UnreadKeys& unread = {});

/// [main] Returns true for each model that will move in a way that was hardly meant, because implausibleValues() warns
/// of a value such as a mass in grams.
std::vector<bool> strayModels(const scene::Scene& scene, const ModelBoxes& boxes, host::Catalog& catalog);

/// Warns of each parameter by itself, by the unit that its plugin gives for it.
void checkQuantities(const GivenModel& given);

/// Warns of parameters of a body that moves by its weight and the forces on it.
void checkBody(const GivenModel& given);

/// Warns of parameters that have no effect, because another parameter of the model switches them off.
void checkIdleParameters(const GivenModel& given);

/// [main] Returns the groups of models that have the same geometry in the same place, as a copy whose pose was not
/// changed. Each group has the indices of its models, in scene order.
std::vector<std::vector<size_t>> modelsInOnePlace(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
