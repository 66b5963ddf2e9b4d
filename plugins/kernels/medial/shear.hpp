// SPDX-License-Identifier: MIT
/// The force of a pressed surface: a normal spring and four springs along the surface (Corso et al. 2002, section 3.4).
#pragma once
#include <Eigen/Core>
#include <array>
#include <span>

namespace hapticd::medial {

/// A spring from the contact point to a point of the contour beside it. Its length at rest is the chord before the
/// press.
struct ShearSpring {
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< [m] the neighbour on the contour
  double stiffness = 0;                              ///< [N/m] mean of the two ends
};

/// [rt] Force [N] on a probe at `probe` that pressed the contour at `surface` with outward unit normal `normal`:
/// stiffness * depth outward plus every shear spring as a vector (the paper's sum of magnitudes has no direction).
Eigen::Vector3d pressForce(const Eigen::Vector3d& probe, const Eigen::Vector3d& surface, const Eigen::Vector3d& normal,
                           double stiffness, double depth, std::span<const ShearSpring> springs) noexcept;

/// Whether the outward force of four neighbours on a round cap grows with every depth.
struct Monotonicity {
  double ratio = 1;  ///< rest length of a spring over its least length while pressed along the normal
  double limit = 1;  ///< 1 + k / (4 keq): the ratio must stay below
  bool holds() const noexcept { return ratio < limit; }
};

/// [any] For neighbours at arc angle `angle` [rad] from the contact on a cap: the springs are shortest when the contact
/// has come down to their plane, at 1 / cos(angle / 2) of the chord.
Monotonicity monotonicity(double angle, double stiffness, double shear_stiffness) noexcept;

}  // namespace hapticd::medial
