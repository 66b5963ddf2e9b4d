// SPDX-License-Identifier: MIT
/// Finds real arms of a scene that nothing tells apart: the first one that is found would become the first of the
/// scene, so that the hands may change places from run to run. Only the files are read.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Returns a warning for each arm whose USB device may be that of an earlier arm of the scene.
document::Problems likeArms(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
