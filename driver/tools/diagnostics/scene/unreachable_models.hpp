// SPDX-License-Identifier: MIT
/// Warnings about models that no hand can touch, because they are out of reach or inside a solid.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "description/scene.hpp"
#include "document/problem.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// How far one arm can move its tip from the tip's position in the first tick.
struct TipReach {
  Eigen::Vector3d tip;  ///< [m] world, at the first tick
  double reach = 0;     ///< [m]
};

/// [main] Warns of models at rest that no arm can reach. @param world world of the scene, after its first tick
/// @param tips reach of each arm, in the order of its probes
document::Problems unreachableModels(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                     const std::vector<TipReach>& tips);

/// [main] Warns of models at rest that lie deep within a rigid model at rest. @param world world of the scene
document::Problems enclosedModels(const scene::Scene& scene, const servo::World& world);

}  // namespace hapticd::diagnostics
