// SPDX-License-Identifier: MIT
/// Warnings about models that no hand can touch: they are out of reach or inside something solid.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// The reach of one arm from the place of its tip at the first tick.
struct TipReach {
  Eigen::Vector3d tip;  ///< [m] world, at the first tick
  double reach = 0;     ///< [m]
};

/// [main] Warns of models at rest that no arm reaches. @param world the scene's, after its first tick @param tips of
/// all arms, in the order of its probes
document::Problems unreachableModels(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                     const std::vector<TipReach>& tips);

/// [main] Warns of models at rest that lie deep within a rigid one at rest. @param world the scene's
document::Problems enclosedModels(const scene::Scene& scene, const servo::World& world);

}  // namespace hapticd::diagnostics
