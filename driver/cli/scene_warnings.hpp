// SPDX-License-Identifier: MIT
/// Finds unusual settings of a scene's models, for `check` and for models that are added to a running daemon.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/reading/unread_keys.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "document/problem.hpp"
#include "session/runner.hpp"

namespace hapticd::cli {

/// [main] Warns of a model that is so far away that no arm reaches it, probably because its position is in another
/// unit.
document::Problems farModels(const scene::Scene& scene);

/// [main] Warns of a stiffness too small to feel. It was probably given in N/mm, as in data sheets: read as N/m it is a
/// thousandth of that.
document::Problems softModels(const scene::Scene& scene);

/// [main] Returns the scene, with the arm that `run` uses if the scene names none.
scene::Scene withArm(scene::Scene scene);

/// [main] Warns of contacts that cannot be stable. Only simulated arms are opened, because `check` touches no hardware.
/// For a real arm the numbers of its file are used. `run` gives these warnings as well. @param stiffness [N/m]
/// stiffness that each model claims, in scene order
document::Problems unstableContacts(const scene::Scene& scene, const std::vector<double>& stiffness);

/// [main] Warns of a bound for programs (clients.max_force) above the arm's own limit, because it has no effect.
document::Problems idleBounds(const scene::Scene& scene);

/// [main] Warns of models that `run` would leave out because their plugin is in quarantine.
document::Problems quarantinedModels(const scene::Scene& scene);

/// [main] Adds warnings about unusual values. A value that already has a warning gets no second one.
/// @param boxes boxes of the models from tryModels()
/// @param unread keys that could not be read; no warning depends on them
void addImplausible(const scene::Scene& scene, const diagnostics::ModelBoxes& boxes,
                    const diagnostics::UnreadKeys& unread, document::Problems& warnings);

/// [any] Returns the warnings that `check` would give about models that are added to a run. @param stiffness [N/m]
/// stiffness that each of the models claims
std::vector<std::string> warningsOfModels(const servo::Runner& runner, const scene::Scene& models,
                                          const std::vector<double>& stiffness);

}  // namespace hapticd::cli
