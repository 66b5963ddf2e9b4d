// SPDX-License-Identifier: MIT
/// Nearest points of leaves and of pieces of curves: Newton, kept inside the piece.
#pragma once
#include "kernels/brep/elements.hpp"

namespace hapticd::brep {

/// What a search learns from one such element.
struct PieceAnswer {
  double d2 = std::numeric_limits<double>::infinity();  ///< [m^2] of the nearest foot found, also if it was not taken
  double region2 =
      std::numeric_limits<double>::infinity();  ///< [m^2] of a leaf: the same, also of feet that are refused
  bool alone = true;                            ///< no other point of the element can be nearer than both
  int evaluations = 0;
  int starts = 1;  ///< of Newton
};

/// How to look for a foot on a leaf.
struct LeafStart {
  Eigen::Array2d uv;
  LeafSight sight;        ///< what the probe sees of the leaf
  bool elsewhere = true;  ///< where there may be several feet, look from the corners too
  double limit2 = std::numeric_limits<double>::infinity();  ///< [m^2] a leaf that is farther need not be told exactly
};

/// [rt] Foot of p on a leaf. A foot that lies on a border of the surface, or of the box of the loops, without being
/// stationary there, is refused: the edge there tells more exactly.
PieceAnswer leafFoot(const Geometry& geometry, const Leaf& leaf, const FaceShape& face, std::uint32_t surface,
                     const Eigen::Vector3d& p, const LeafStart& start, Hit& hit) noexcept;

/// [rt] Foot of p on a piece of a curve, from t on. @param limit2 [m^2] a piece that is farther need not be told
/// exactly
PieceAnswer pieceFoot(const Geometry& geometry, const CurvePiece& piece, const Eigen::Vector3d& p, double t,
                      double limit2, Hit& hit) noexcept;

}  // namespace hapticd::brep
