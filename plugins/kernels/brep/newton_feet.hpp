// SPDX-License-Identifier: MIT
/// Nearest points of leaves and of pieces of curves: Newton, kept inside the piece.
#pragma once
#include "kernels/brep/elements.hpp"

namespace hapticd::brep {

/// What a search learns from one such element.
struct PieceAnswer {
  double d2 = std::numeric_limits<double>::infinity();  ///< [m^2] of the nearest foot found, also if it was not taken
  bool alone = true;                                    ///< no other point of the element can be nearer than both
  int evaluations = 0;
};

/// [rt] Foot of p on a leaf, from (u, v) on. A foot that lies on a border of the surface, or of the box of the loops,
/// without being stationary there, is refused: the edge there tells more exactly.
PieceAnswer leafFoot(const Geometry& geometry, const Leaf& leaf, const FaceShape& face, std::uint32_t surface,
                     const Eigen::Vector3d& p, const Eigen::Array2d& uv, Hit& hit) noexcept;

/// [rt] Foot of p on a piece of a curve, from t on.
PieceAnswer pieceFoot(const Geometry& geometry, const CurvePiece& piece, const Eigen::Vector3d& p, double t,
                      Hit& hit) noexcept;

}  // namespace hapticd::brep
