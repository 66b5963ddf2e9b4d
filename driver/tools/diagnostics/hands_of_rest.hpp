// SPDX-License-Identifier: MIT
/// Judges the hands of a scene of which some models have problems.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/model_trial.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the warnings of warnOfHands() for the scene without the models that have problems. Whether a hand
/// feels anything is judged only if all these models lie away from it.
/// @param boxes boxes of the models from tryModels()
/// @param left_out true for each model that has a problem
/// @param placed true for each model whose position could be read
document::Problems warnOfHandsOfRest(const scene::Scene& scene, const ModelBoxes& boxes,
                                     const std::vector<bool>& left_out, const std::vector<bool>& placed,
                                     host::Catalog& catalog);

/// [main] Returns the index of the model that a key such as "models[3].pose" is about.
std::optional<size_t> modelOf(const std::string& key);

}  // namespace hapticd::diagnostics
