// SPDX-License-Identifier: MIT
/// Warns of paths that lead a model far away from all arms.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of the first row of each path in which the model is where no arm reaches, probably because the
/// positions are in mm. The warning stands at the row in the path's file.
document::Problems farPaths(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
