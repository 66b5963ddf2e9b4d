// SPDX-License-Identifier: MIT
/// The force of a pressed surface: a normal spring, four springs along the surface (Corso et al. 2002, section 3.4),
/// and the slope of a stiffness that changes.
#pragma once
#include <Eigen/Core>
#include <array>
#include <span>

namespace hapticd::medial {

/// A spring from the contact point to a point of the contour beside it. Its rest length is the distance of both points
/// before the press.
struct ShearSpring {
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< [m] the neighbouring point of the contour
  double stiffness = 0;                              ///< [N/m] mean of the stiffness at the two ends
};

/// [rt] Returns the force [N] on a probe at `probe` that presses the contour at the point `surface`, which has the
/// outward unit normal `normal`. It is stiffness * depth outward, plus the force vector of every shear spring (the
/// paper adds magnitudes, which have no direction).
Eigen::Vector3d pressForce(const Eigen::Vector3d& probe, const Eigen::Vector3d& surface, const Eigen::Vector3d& normal,
                           double stiffness, double depth, std::span<const ShearSpring> springs) noexcept;

/// [rt] Returns the part along the surface of the force [N] on a probe, where the stiffness changes along the surface
/// by `slope` [N/m^2]. It is the slope of the energy of the press, toward the softer side: without it, a hand that goes
/// in where the body is soft and out where it is stiff would gain energy.
/// @param per_stiffness [m^2] energy of the press divided by the stiffness: depth^2 / 2 of a normal spring
/// @param most [N] its greatest length; the slope of a deep press would be a wall
Eigen::Vector3d forceAlong(const Eigen::Vector3d& slope, const Eigen::Vector3d& normal, double per_stiffness,
                           double most) noexcept;

}  // namespace hapticd::medial
