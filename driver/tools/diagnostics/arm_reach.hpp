// SPDX-License-Identifier: MIT
/// How far an arm can move its tip, and how far away the models of a scene are.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "description/scene.hpp"
#include "host/device_instance.hpp"
#include "world/world.hpp"

namespace hapticd::diagnostics {

/// [main] [m] The farthest that the joints move the tip away from where it is, within arm.limits if they are given;
/// generous if they are not.
double reachOf(const scene::Device& device, const host::DeviceInstance& arm, const Eigen::Vector3d& tip_device);

/// [main] [m] From a tip to one model, as below.
std::optional<double> distanceOf(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                 uint32_t model, const Eigen::Vector3d& tip, uint32_t probe);

/// The model that is nearest to a tip.
struct NearestModel {
  size_t index = 0;
  double away = 0;  ///< [m] from the tip to the surface, or to a box about the model
};

/// [main] Over the whole path of a model that moves along one. Nothing where some model does not say where it is: it
/// may be anywhere. @param world the scene's, after its first tick @param probe which of its probes `tip` is
std::optional<NearestModel> nearestModel(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                         const Eigen::Vector3d& tip, uint32_t probe);

}  // namespace hapticd::diagnostics
