// SPDX-License-Identifier: MIT
/// Judges a scene that could be read as a whole.
#pragma once
#include "description/scene.hpp"
#include "diagnostics/check/check_result.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Tries the modules of a scene's arms in child processes, before any of them is loaded here, and returns what a
/// run would refuse or where it would crash.
document::Problems badModules(const scene::Scene& scene, host::Catalog& catalog);

/// [main] Adds what `run` would refuse, and warnings about what is allowed but was hardly meant. Modules that
/// badModules() found must not be in the scene, because some are called in this process.
void judgeScene(const scene::Scene& scene, const CheckOptions& options, host::Catalog& catalog, CheckResult& result);

}  // namespace hapticd::diagnostics
