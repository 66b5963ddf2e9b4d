// SPDX-License-Identifier: MIT
/// Judges what could be read of a scene that has problems, so that `check` reports everything at once.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::cli {

/// [main] Sets up the models and judges the values that were read. A judgement that depends on a value with a problem
/// is left out. @param draft the scene as far as it was read @param problems problems of the scene; those of its models
/// are added
void checkDraft(scene::Scene draft, document::Problems& problems, document::Problems& warnings);

}  // namespace hapticd::cli
