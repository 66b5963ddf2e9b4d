// SPDX-License-Identifier: MIT
/// Finds how far the models of a scene are from a tip.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "description/scene.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// [main] Returns the distance [m] from a tip to one model; nothing if the model gives no distance.
std::optional<double> distanceOf(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                 uint32_t model, const Eigen::Vector3d& tip, uint32_t probe);

/// The model that is nearest to a tip.
struct NearestModel {
  size_t index = 0;
  double away = 0;  ///< [m] distance from the tip to the surface, or to a box around the model
};

/// [main] Returns the model that is nearest to `tip`. If a model moves along a path, its nearest pose on this path is
/// used. Returns nothing if some model does not report its box, because it may be anywhere.
/// @param world world of the scene, after its first tick
/// @param probe index of the probe whose tip is `tip`
std::optional<NearestModel> nearestModel(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                         const Eigen::Vector3d& tip, uint32_t probe);

}  // namespace hapticd::diagnostics
