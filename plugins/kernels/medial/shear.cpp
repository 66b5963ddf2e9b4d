// SPDX-License-Identifier: MIT
#include "kernels/medial/shear.hpp"

namespace hapticd::medial {

Eigen::Vector3d pressForce(const Eigen::Vector3d& probe, const Eigen::Vector3d& surface, const Eigen::Vector3d& normal,
                           double stiffness, double depth, std::span<const ShearSpring> springs) noexcept {
  Eigen::Vector3d force = stiffness * depth * normal;
  for (const ShearSpring& spring : springs) {
    const Eigen::Vector3d chord = spring.anchor - probe;
    const double length = chord.norm(), rest = (spring.anchor - surface).norm();
    // pulls if it is stretched, pushes if it is shortened
    if (length > 0) force += spring.stiffness * (1 - rest / length) * chord;
  }
  return force;
}

Eigen::Vector3d forceAlong(const Eigen::Vector3d& slope, const Eigen::Vector3d& normal, double per_stiffness,
                           double most) noexcept {
  const Eigen::Vector3d along = -per_stiffness * (slope - slope.dot(normal) * normal);
  const double length = along.norm();
  return length > most ? Eigen::Vector3d(most / length * along) : along;
}

}  // namespace hapticd::medial
