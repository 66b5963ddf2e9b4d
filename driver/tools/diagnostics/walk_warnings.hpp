// SPDX-License-Identifier: MIT
/// Warns of what a simulated hand meets in a scene and nobody meant: no model at all, a force that cannot be felt, a
/// force that the limits cut.
#pragma once
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// [main] Moves the hands of simulated arms through a scene, and warns of a hand that touches no model, of a model
/// whose force is too small to feel, of limits that cut the force, and of a button that does not click. @param world
/// world of the scene, built for as many probes as it has arms @param strays true for each model that moves as nobody
/// meant: what a hand meets of it follows from that, and is not told
document::Problems warnOfWalk(const scene::Scene& scene, servo::World& world, const std::vector<bool>& strays);

}  // namespace hapticd::diagnostics
