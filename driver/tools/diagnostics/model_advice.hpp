// SPDX-License-Identifier: MIT
/// Numbers of a scene that its files allow and that cannot be meant: grams for kilograms, millimetres for metres,
/// degrees for radians, one place given twice. Nothing is set up to find them.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of parameters of the models that ship with hapticd, and of models that lie in one another.
document::Problems doubtfulModels(const scene::Scene& scene);

/// [main] Warns of the rest of a scene: gravity that points up, arms that stand in one place, a simulated hand that
/// turns or moves as no hand does.
document::Problems doubtfulSettings(const scene::Scene& scene);

}  // namespace hapticd::diagnostics
