// SPDX-License-Identifier: MIT
/// Warns of rigid models that lie in one another.
#pragma once
#include "description/scene.hpp"
#include "document/problem.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of pairs of rigid solids that overlap at the start by more than 1 mm, because a hand there feels the
/// sum of both. Models that touch, rows of four and more of the same geometry, open surfaces, soft bodies and models
/// that their plugins move are not judged.
/// @param world world of the scene
document::Problems overlappingModels(const scene::Scene& scene, const servo::World& world);

}  // namespace hapticd::diagnostics
