// SPDX-License-Identifier: MIT
/// Centre and inertia of a solid of constant density, from integrals over its surface.
#pragma once
#include <Eigen/Geometry>

namespace hapticd::dynamics {

/// Properties of a solid of 1 kg.
struct MassProperties {
  Eigen::Vector3d center{0, 0, 0};                        ///< of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();  ///< about the centre [m^2]; times the mass: [kg m^2]
};

/// [any] A full box.
MassProperties boxProperties(const Eigen::AlignedBox3d& box) noexcept;

/// The volume integrals of a closed surface, by the divergence theorem.
class SolidIntegral {
 public:
  /// [any] @param origin near the solid [m], so that a solid far from the frame's origin loses no digits
  explicit SolidIntegral(const Eigen::Vector3d& origin) noexcept : origin_(origin) {}
  /// [any] A piece of the surface: a point [m] and its outward area vector [m^2].
  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& area) noexcept;
  double volume() const noexcept { return volume_; }  ///< [any] [m^3] negative if the surface is inside out
  /// [any] What the pieces bound; volume() is not 0.
  MassProperties properties() const noexcept;

 private:
  Eigen::Vector3d origin_;
  double volume_ = 0;
  Eigen::Vector3d first_{0, 0, 0};                    // integrals of x
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();  // integrals of x y
};

/// [any] Principal moments of an inertia [kg m^2], ascending.
/// @throws std::invalid_argument unless it is symmetric and positive definite.
Eigen::Vector3d principalMoments(const Eigen::Matrix3d& inertia);

/// [any] True if a body of positive mass everywhere can have this inertia about its centre: besides the above, no
/// principal moment exceeds the sum of the others. @throws std::invalid_argument with the moments.
void validateSolid(const Eigen::Matrix3d& inertia);

}  // namespace hapticd::dynamics
