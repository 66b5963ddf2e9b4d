// SPDX-License-Identifier: MIT
#include "diagnostics/scene/nearest_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace hapticd::diagnostics {
namespace {

using Eigen::Vector3d;

/// [m] Returns the distance from a tip to the box of a model in one pose, which is at most the distance to the model
/// itself.
double awayFrom(const Eigen::AlignedBox3d& box, const scene::Pose& pose, const Vector3d& tip) {
  return box.exteriorDistance(Vector3d(pose.orientation.conjugate() * (tip - pose.position)));
}

/// [m] Returns the least distance over all poses of a model's path; nothing if it is unknown.
std::optional<double> distanceTo(const scene::Model& model, const host::ShapeInstance& shape,
                                 const servo::Contact& contact, const Vector3d& tip) {
  Eigen::AlignedBox3d box;
  if (shape.bounds(box.min().data(), box.max().data())) {
    double least = awayFrom(box, model.pose, tip);
    for (const scene::PathPoint& point : model.path) least = std::min(least, awayFrom(box, point.pose, tip));
    return least;
  }
  if (!contact.traced || model.kinematic) return std::nullopt;
  return (Vector3d(contact.world.point) - tip).norm();
}

}  // namespace

std::optional<double> distanceOf(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                 uint32_t model, const Vector3d& tip, uint32_t probe) {
  return distanceTo(scene.models[model], *world.shapes()[model], core.contact(model, probe), tip);
}

std::optional<NearestModel> nearestModel(const scene::Scene& scene, const servo::World& world, servo::Core& core,
                                         const Vector3d& tip, uint32_t probe) {
  std::optional<NearestModel> nearest;
  for (uint32_t i = 0; i < scene.models.size(); ++i) {
    const auto away = distanceOf(scene, world, core, i, tip, probe);
    if (!away) return std::nullopt;
    if (!nearest || *away < nearest->away) nearest = {i, *away};
  }
  return nearest;
}

}  // namespace hapticd::diagnostics
