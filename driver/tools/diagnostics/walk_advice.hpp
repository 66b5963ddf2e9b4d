// SPDX-License-Identifier: MIT
/// What hands met in a scene that nobody can have meant: nothing at all, what cannot be felt, what the limits cut.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// [main] Walks the hands of simulated arms through a scene, and warns of what that shows: a hand that never comes near
/// a model, a model whose force nobody feels, limits that cut the force asked, a button that does not click.
/// @param world of the scene, built for as many probes as it has arms
document::Problems adviseWalk(const scene::Scene& scene, servo::World& world);

}  // namespace hapticd::diagnostics
