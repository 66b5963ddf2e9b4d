// SPDX-License-Identifier: MIT
/// Warns of paths of kinematic models whose times seem to be in milliseconds.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of a path with times in whole numbers along which its model creeps, at the row with the longest wait.
document::Problems slowPaths(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
