// SPDX-License-Identifier: MIT
/// Judges the hands of a scene of which some models have problems.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the warnings of warnOfHands() for the scene without the models that have problems. Whether a hand
/// feels anything is judged only if all these models lie away from it.
/// @param boxes boxes of the models from tryModels()
/// @param left_out true for each model that has a problem, except for those that leaveOutCurves() keeps
/// @param placed true for each model whose position could be read
/// @param known as for warnOfHands()
document::Problems warnOfHandsBesideProblems(const scene::Scene& scene, const ModelBoxes& boxes,
                                             const std::vector<bool>& left_out, const std::vector<bool>& placed,
                                             host::Catalog& catalog, bool known = true);

/// [main] Removes from a model the wrong parameters that change only how it feels, such as the detent of a button. The
/// surfaces are where they are without them, so a hand can be judged.
/// @param problems all problems of the model
/// @return true if the model has no other problem
bool leaveOutCurves(scene::Model& model, size_t index, const document::Problems& problems);

/// [main] Removes warnings that may only follow from parameters that leaveOutCurves() removed.
/// @param curved true for each model that it kept
void dropOfCurves(const std::vector<bool>& curved, document::Problems& warnings);

/// [main] Returns true if a warning says that a model's surfaces are not where they were meant, so that what a hand
/// meets there only follows from it.
bool isOfSurfaces(const document::Problem& warning);

}  // namespace hapticd::diagnostics
