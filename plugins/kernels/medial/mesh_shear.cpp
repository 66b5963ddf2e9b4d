// SPDX-License-Identifier: MIT
/// Springs from a pressed place of a medial mesh to points of the contour beside it, which may lie on other cones and
/// slabs.
#include <algorithm>

#include "kernels/medial/mesh_body.hpp"
#include "kernels/medial/shear.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

/// most nodes of the tree that are visited for one neighbour; near the surface some tens suffice
constexpr int kMostVisits = 400;
/// If the sine of the angle between an axis of the model frame and the normal is below this, the axis has no direction
/// along the surface.
constexpr double kLeastAside = 1e-6;

}  // namespace

/// A mesh has no rows, so the neighbours lie along the axes of the model frame, projected on the surface, forward and
/// back. The weight of each neighbour is the squared length of its projected axis. So the six together have the same
/// effect for every orientation of the surface, and the force does not jump where cones and slabs meet.
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
      // less than 1 at a rim
      const double reached = std::clamp((spring.anchor - surface).dot(aside) / distance, 0.0, 1.0);
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
