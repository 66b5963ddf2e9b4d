// SPDX-License-Identifier: MIT
/// Finds settings of a scene's models that nobody meant, for `check` and for models that are added to a running daemon.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "session/runner.hpp"

namespace hapticd::cli {

/// [main] Warns of a model so far away that no arm reaches it, because its position was meant in another unit.
document::Problems farModels(const scene::Scene& scene);

/// [main] Warns of a stiffness too small to feel, because it was given in N/mm, as data sheets do; read as N/m it is a
/// thousandth of what was meant.
document::Problems softModels(const scene::Scene& scene);

/// [any] Returns the warnings that `check` would give about models that are added to a run. @param stiffness [N/m]
/// stiffness that each of the models claims
std::vector<std::string> adviceOnModels(const servo::Runner& runner, const scene::Scene& models,
                                        const std::vector<double>& stiffness);

}  // namespace hapticd::cli
