// SPDX-License-Identifier: MIT
/// Springs from a pressed place of a medial mesh to the contour beside it, whichever cones and slabs that is on.
#include <algorithm>

#include "kernels/medial/mesh_body.hpp"
#include "kernels/medial/shear.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

constexpr int kMostVisits = 400;  ///< nodes of the tree for one neighbour: some tens suffice at the surface
constexpr double kLeastAside =
    1e-6;  ///< sine below which an axis of the model's frame has no direction along a surface

}  // namespace

/// A mesh has no rows. The neighbours are in the directions of the model's axes along the surface, forward and back;
/// each counts by how far its axis lies in the surface, squared. So the six together are the same for every direction
/// of the surface, and nothing jumps where cones and slabs meet.
std::size_t MeshBody::neighboursOf(const Vector3d& surface, const SkeletonFoot& foot, const Vector3d& normal,
                                   std::array<ShearSpring, 6>& springs) const noexcept {
  const double here = material(stiffness_, foot), distance = options_.shear_distance;
  std::size_t count = 0;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3d along = Vector3d::Unit(k) - normal[k] * normal;
    const double share = along.squaredNorm();
    if (!(share > kLeastAside * kLeastAside)) continue;
    for (const double sign : {-1.0, 1.0}) {
      const Vector3d aside = sign / std::sqrt(share) * along;
      const SkeletonFoot there = this->foot(surface + distance * aside, foot.element, 0, kMostVisits);
      if (!there.converged) continue;
      ShearSpring& spring = springs[count];
      spring.anchor = there.center + there.radius * there.normal;
      const double reached = std::clamp((spring.anchor - surface).dot(aside) / distance, 0.0, 1.0);  // less at a rim
      spring.stiffness = 0.25 * share * reached * 0.5 * (here + material(stiffness_, there));
      count += spring.stiffness > 0 ? 1 : 0;
    }
  }
  return count;
}

BodyForce MeshBody::press(const Vector3d& p, const SkeletonFoot& foot, const Vector3d& normal, double depth,
                          double closing_speed) const noexcept {
  BodyForce result = press(foot, normal, depth, closing_speed);
  if (!(options_.shear_distance > 0) || !(depth > 0)) return result;
  std::array<ShearSpring, 6> springs;
  const Vector3d surface = p + depth * normal;
  const std::size_t count = neighboursOf(surface, foot, normal, springs);
  const Vector3d pulled = pressForce(p, surface, normal, 0, depth, {springs.data(), count});
  result.force += pulled - pulled.dot(normal) * normal;
  return result;
}

}  // namespace hapticd::medial
