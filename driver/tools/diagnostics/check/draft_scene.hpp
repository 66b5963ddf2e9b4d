// SPDX-License-Identifier: MIT
/// Judges the readable part of a scene with problems, so that `check` reports all problems at once.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Sets up the models and checks the values that could be read. A check that depends on a value with a problem
/// is left out.
/// @return true if the hands of the arms were moved through the models that have no problem
/// @param draft the part of the scene that could be read
/// @param setup_seconds [s] longest time of one call of a plugin in the set-up of a model
/// @param problems problems of the scene; those of its models are added
/// @param warnings warnings about the scene; those about its models are added
bool judgeDraftScene(scene::Scene draft, host::Catalog& catalog, double setup_seconds, document::Problems& problems,
                     document::Problems& warnings);

}  // namespace hapticd::diagnostics
