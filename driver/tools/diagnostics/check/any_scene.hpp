// SPDX-License-Identifier: MIT
/// What is judged alike of a scene that could be read and of one with problems.
#pragma once
#include <filesystem>

#include "description/scene.hpp"
#include "diagnostics/reading/unread_keys.hpp"
#include "diagnostics/scene/model_trial.hpp"
#include "document/problem.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the scene, with the arm that `run` uses if the scene names none.
scene::Scene withArm(scene::Scene scene, host::Catalog& catalog);

/// [main] Warns of slips in the text of a scene file: decimal commas, quaternions in another order, mounts in
/// millimetres, and a hand that is given twice.
void warnOfSlips(const std::filesystem::path& file, document::Problems& warnings);

/// [main] Adds warnings about unusual values. A value that already has a warning gets no second one.
/// @param boxes boxes of the models from tryModels()
/// @param unread keys that could not be read; no warning depends on them
void addImplausible(const scene::Scene& scene, const ModelBoxes& boxes, host::Catalog& catalog,
                    const UnreadKeys& unread, document::Problems& warnings);

}  // namespace hapticd::diagnostics
