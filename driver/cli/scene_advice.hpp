// SPDX-License-Identifier: MIT
/// What of a scene's models nobody can have meant: for `check`, and for who adds models to a running daemon.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "session/runner.hpp"

namespace hapticd::cli {

/// [main] Warns of a model so far away that no arm reaches it: its numbers were meant in other units.
document::Problems farModels(const scene::Scene& scene);

/// [main] Warns of a stiffness in N/mm, as data sheets have it: a thousandth of what was meant, which nobody feels.
document::Problems softModels(const scene::Scene& scene);

/// [any] Warns of models that are added to a run as `check` would. @param stiffness [N/m] that each of them claims
std::vector<std::string> adviceOnModels(const servo::Runner& runner, const scene::Scene& models,
                                        const std::vector<double>& stiffness);

}  // namespace hapticd::cli
