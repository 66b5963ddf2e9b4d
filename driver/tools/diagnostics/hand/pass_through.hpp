// SPDX-License-Identifier: MIT
/// Warns of hands that press through a model.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of a hand that presses deeper than a model is thick, so that it comes out behind. @param boxes boxes of
/// the models from tryModels() @param moves true for each model that its plugin moves: how far a hand may press it, its
/// thickness does not say
document::Problems pressesThrough(const scene::Scene& scene, const ModelBoxes& boxes, const std::vector<bool>& moves);

}  // namespace hapticd::diagnostics
