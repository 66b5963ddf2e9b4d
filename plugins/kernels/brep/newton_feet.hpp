// SPDX-License-Identifier: MIT
/// Nearest points of leaves and of pieces of curves: Newton, kept inside the piece.
#pragma once
#include "kernels/brep/elements.hpp"

namespace hapticd::brep {

/// What a search learns from one such element.
struct PieceAnswer {
  double d2 = std::numeric_limits<double>::infinity();  ///< [m^2] of the nearest foot found, also if it was not taken
  double region2 =
      std::numeric_limits<double>::infinity();  ///< [m^2] of a leaf: the same, including feet that are refused
  bool alone = true;                            ///< no other point of the element can be nearer than both
  int evaluations = 0;
  int starts = 1;  ///< of Newton
};

/// How to search for a foot on a leaf.
struct LeafStart {
  Eigen::Array2d uv;
  LeafSight sight;        ///< how the probe sees the leaf
  bool elsewhere = true;  ///< if there may be several feet, start from the corners too
  double limit2 = std::numeric_limits<double>::infinity();  ///< [m^2] a leaf that is farther need not be told exactly
};

/// [rt] Foot of p on a leaf. A foot on a border of the surface, or of the box of the loops, that is not stationary
/// there is refused, because the edge there is more exact.
PieceAnswer leafFoot(const Geometry& geometry, const Leaf& leaf, const FaceShape& face, std::uint32_t surface,
                     const Eigen::Vector3d& p, const LeafStart& start, Hit& hit) noexcept;

/// [rt] Foot of p on a piece of a curve, from t on. @param limit2 [m^2] a piece that is farther need not be measured
/// exactly
PieceAnswer pieceFoot(const Geometry& geometry, const CurvePiece& piece, const Eigen::Vector3d& p, double t,
                      double limit2, Hit& hit) noexcept;

}  // namespace hapticd::brep
