// SPDX-License-Identifier: MIT
/// Judges models that are added to a running daemon.
#pragma once
#include <string>
#include <vector>

#include "description/scene.hpp"
#include "host/catalog.hpp"
#include "session/run/runner.hpp"

namespace hapticd::diagnostics {

/// [any] Returns the warnings that `check` would give about the models of a scene that are added to a run.
/// @param stiffness [N/m] stiffness that each of the models claims
std::vector<std::string> warningsOfAddedModels(const servo::Runner& runner, const scene::Scene& models,
                                               const std::vector<double>& stiffness, host::Catalog& catalog);

}  // namespace hapticd::diagnostics
