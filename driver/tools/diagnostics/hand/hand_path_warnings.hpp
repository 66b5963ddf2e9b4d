// SPDX-License-Identifier: MIT
/// Judges the path file of a simulated hand before a run follows it.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of rows that the arm cannot follow, because they are out of its reach or a joint would be beyond its
/// stop.
document::Problems unreachableRows(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
