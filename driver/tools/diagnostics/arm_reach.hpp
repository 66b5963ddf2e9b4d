// SPDX-License-Identifier: MIT
/// Finds how far an arm can move its tip, and how far away the models of a scene are.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "description/scene.hpp"
#include "host/device_instance.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// [main] [m] Returns the farthest distance that the joints can move the tip from where it is, within arm.limits.
/// Without arm.limits the distance is an overestimate.
double reachOf(const scene::Device& device, const host::DeviceInstance& arm, const Eigen::Vector3d& tip_device);

/// [main] Returns the distance in m from a tip to one model, or nothing if the model cannot tell.
std::optional<double> distanceOf(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                 uint32_t model, const Eigen::Vector3d& tip, uint32_t probe);

/// The model that is nearest to a tip.
struct NearestModel {
  size_t index = 0;
  double away = 0;  ///< [m] distance from the tip to the surface, or to a box around the model
};

/// [main] Returns the model that is nearest to `tip`. For a model that moves along a path, the nearest pose of the path
/// counts. Returns nothing if a model does not report its box, because it may be anywhere. @param world world of the
/// scene, after its first tick @param probe index of the probe whose tip is `tip`
std::optional<NearestModel> nearestModel(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                         const Eigen::Vector3d& tip, uint32_t probe);

}  // namespace hapticd::diagnostics
