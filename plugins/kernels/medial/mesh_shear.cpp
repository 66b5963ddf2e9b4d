// SPDX-License-Identifier: MIT
/// The force of a pressed place of a medial mesh, whose stiffness may change from vertex to vertex.
#include <algorithm>
#include <cmath>

#include "kernels/medial/mesh_body.hpp"
#include "kernels/medial/shear.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

/// The search for one neighbour ends after visiting this many nodes of the mesh's search tree. Near the surface some
/// tens of nodes suffice.
constexpr int kMostVisits = 400;
/// [m] distance over which the slope is taken if `shear_distance` gives none. The stiffness has kinks where slabs meet,
/// so the slope at a point would change there in one step.
constexpr double kBeside = 1e-3;
/// If the sine of the angle between an axis of the model frame and the normal is below this, the axis has no direction
/// along the surface.
constexpr double kLeastAside = 1e-6;

}  // namespace

/// A mesh has no rows, so the stiffness is compared along the axes of the model frame, projected on the surface,
/// forward and back. Each difference counts by the squared length of its projected axis: so together they are the
/// gradient, for every orientation of the surface, and it does not jump where cones and slabs meet.
Vector3d MeshBody::slopeOfStiffness(const Vector3d& p, const SkeletonFoot& foot, const Vector3d& normal,
                                    double depth) const noexcept {
  Vector3d slope = Vector3d::Zero();
  if (stiffness_.size() == 1) return slope;
  const double distance = options_.shear_distance > 0 ? options_.shear_distance : kBeside;
  const Vector3d surface = p + depth * normal;
  const auto stiffnessAt = [&](const Vector3d& place) {
    return material(stiffness_, this->foot(place, foot.element, 0, kMostVisits));
  };
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3d along = Vector3d::Unit(k) - normal[k] * normal;
    const double length = along.norm();
    if (!(length > kLeastAside)) continue;
    const Vector3d aside = distance / length * along;
    slope += (stiffnessAt(surface + aside) - stiffnessAt(surface - aside)) / (2 * distance) * length * along;
  }
  return slope;
}

BodyForce MeshBody::press(const Vector3d& p, const SkeletonFoot& foot, const Vector3d& normal, double depth,
                          double closing_speed) const noexcept {
  BodyForce result;
  if (!(depth > 0)) return result;
  result.stiffness = material(stiffness_, foot);
  result.energy = 0.5 * result.stiffness * depth * depth;
  const double outward = result.stiffness * depth;
  const Vector3d along = forceAlong(slopeOfStiffness(p, foot, normal, depth), normal, 0.5 * depth * depth, outward);
  result.elastic = outward * normal + along;
  const double drag = std::isfinite(closing_speed)
                          ? material(damping_, foot) * std::min(1.0, depth / options_.damping_scale) * closing_speed
                          : 0;
  result.normal = std::max(0.0, outward + drag);  // a surface does not pull
  result.force = result.normal * normal + along;
  return result;
}

}  // namespace hapticd::medial
