// SPDX-License-Identifier: MIT
/// Nearest points of leaves and of pieces of curves, by Newton's method, whose iterates are kept inside the leaf or
/// piece.
#pragma once
#include "kernels/brep/elements/elements.hpp"

namespace hapticd::brep {

/// The result of Newton's method on a leaf or on a piece of a curve.
struct NewtonResult {
  /// [m^2] squared distance of the nearest foot found, even if `hit` was nearer; infinite if no foot counts.
  double d2 = std::numeric_limits<double>::infinity();
  /// [m^2] leaves only: the same, including feet outside the trim and feet that are refused (see leafFoot()).
  double untrimmed2 = std::numeric_limits<double>::infinity();
  bool proved = true;  ///< certainly no other point of the element is nearer than d2 and untrimmed2
  int evaluations = 0;
  int starts = 1;  ///< starts of Newton's method
};

/// How to search for a foot on a leaf.
struct LeafStart {
  Eigen::Array2d uv;
  LeafFeet feet;          ///< how many feet the probe has on the leaf
  bool elsewhere = true;  ///< start near the corners too if there may be several feet
  /// [m^2] if the leaf is farther than this, a lower bound is enough.
  double limit2 = std::numeric_limits<double>::infinity();
};

/// [rt] Finds the foot of p on a leaf. A foot at a border of the surface, or of the box of the loops, is refused if the
/// distance would still decrease beyond the border, because the edge there gives a more exact point.
NewtonResult leafFoot(const Geometry& geometry, const Leaf& leaf, const FaceShape& face, std::uint32_t surface,
                      const Eigen::Vector3d& p, const LeafStart& start, Hit& hit) noexcept;

/// [rt] Finds the foot of p on a piece of a curve, starting at t. @param limit2 [m^2] if the piece is farther than
/// this, a lower bound is enough
NewtonResult pieceFoot(const Geometry& geometry, const CurvePiece& piece, const Eigen::Vector3d& p, double t,
                       double limit2, Hit& hit) noexcept;

}  // namespace hapticd::brep
