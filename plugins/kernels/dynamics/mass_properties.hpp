// SPDX-License-Identifier: MIT
/// Centre of mass and inertia of a solid of constant density, from integrals over its surface.
#pragma once
#include <Eigen/Geometry>

namespace hapticd::dynamics {

/// Centre of mass and inertia of a solid of 1 kg.
struct MassProperties {
  Eigen::Vector3d center{0, 0, 0};  ///< centre of mass [m]
  /// inertia about the centre of mass, for 1 kg [m^2]; multiply by the mass to get kg m^2
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Identity();
};

/// [any] Returns the properties of a solid box.
MassProperties boxProperties(const Eigen::AlignedBox3d& box) noexcept;

/// The volume integrals of a closed surface, by the divergence theorem.
class SolidIntegral {
 public:
  /// [any] @param origin a point near the solid [m]; it keeps the precision if the solid is far from the frame's origin
  explicit SolidIntegral(const Eigen::Vector3d& origin) noexcept : origin_(origin) {}
  /// [any] Adds a small piece of the surface. @param point a point of the piece [m]
  /// @param area outward normal times the area of the piece [m^2]
  void add(const Eigen::Vector3d& point, const Eigen::Vector3d& area) noexcept;
  double volume() const noexcept { return volume_; }  ///< [any] [m^3]; negative if the surface is inside out
  /// [any] Returns the properties of the solid that the pieces enclose. volume() must not be 0.
  MassProperties properties() const noexcept;
  /// [any] Returns the properties of the solid if the pieces enclose one, otherwise those of the box around them.
  /// @param bounded in: the surface is closed; out: and it encloses a volume that is not only rounding
  MassProperties propertiesIn(const Eigen::AlignedBox3d& box, bool& bounded) const noexcept;

 private:
  Eigen::Vector3d origin_;
  double volume_ = 0;
  Eigen::Vector3d first_{0, 0, 0};                    // volume integral of x
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();  // volume integrals of the products x_i x_j
};

/// [any] Returns the principal moments of an inertia [kg m^2] in ascending order. @throws std::invalid_argument unless
/// the matrix is symmetric and positive definite.
Eigen::Vector3d principalMoments(const Eigen::Matrix3d& inertia);

/// [any] Checks that a real body can have this inertia about its centre of mass: the conditions of principalMoments()
/// hold, and no principal moment exceeds the sum of the other two. @throws std::invalid_argument that names the
/// moments.
void validateSolid(const Eigen::Matrix3d& inertia);

}  // namespace hapticd::dynamics
