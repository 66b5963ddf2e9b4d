// SPDX-License-Identifier: MIT
/// Warns of unwanted effects that a simulated hand meets in a scene: it touches no model, its force is too small to
/// feel, or the limits cut its force.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// [main] Moves the hands of simulated arms through a scene. Warns of a hand that touches no model, of a model whose
/// force is too small to feel, of limits that cut the force, of a button that does not click, and of an arm that is not
/// stable.
/// @param world world of the scene, built for as many probes as the scene has arms
/// @param strays true for each model that will move in a way that was hardly meant (see strayModels()). Effects of such
/// a model are not reported, because it has a warning already
/// @param all_models false if a hand may be meant for a model that is not in the scene; then no hand is said to feel
/// nothing
document::Problems warnOfWalk(const scene::Scene& scene, servo::World& world, const std::vector<bool>& strays,
                              bool all_models);

}  // namespace hapticd::diagnostics
