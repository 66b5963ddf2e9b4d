// SPDX-License-Identifier: MIT
/// Finds settings of a scene's models that nobody meant, for `check` and for models that are added to a running daemon.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "diagnostics/model_trial.hpp"
#include "diagnostics/unread_keys.hpp"
#include "document/problem.hpp"
#include "session/runner.hpp"

namespace hapticd::cli {

/// [main] Warns of a model so far away that no arm reaches it, because its position was meant in another unit.
document::Problems farModels(const scene::Scene& scene);

/// [main] Warns of a stiffness too small to feel, because it was given in N/mm, as data sheets do; read as N/m it is a
/// thousandth of what was meant.
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

/// [main] Adds warnings about unusual values. A value that has a warning already gets no second one. @param boxes boxes
/// of the models, as tryModels() found them @param unread keys with problems, on which no judgement may depend
void addImplausible(const scene::Scene& scene, const diagnostics::ModelBoxes& boxes,
                    const diagnostics::UnreadKeys& unread, document::Problems& warnings);

/// [any] Returns the warnings that `check` would give about models that are added to a run. @param stiffness [N/m]
/// stiffness that each of the models claims
std::vector<std::string> warningsOfModels(const servo::Runner& runner, const scene::Scene& models,
                                          const std::vector<double>& stiffness);

}  // namespace hapticd::cli
