// SPDX-License-Identifier: MIT
/// Warns of models that no hand will feel: too far away, too soft, or left out by a run.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of a model that is so far away that no arm reaches it, probably because its position is in another
/// unit.
document::Problems farModels(const scene::Scene& scene);

/// [main] Warns of a stiffness too small to feel. It was probably given in N/mm, as in data sheets: read as N/m it is a
/// thousandth of that.
document::Problems softModels(const scene::Scene& scene, host::Catalog& catalog);

/// [main] Warns of models that `run` would leave out because their plugin is in quarantine.
document::Problems quarantinedModels(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
