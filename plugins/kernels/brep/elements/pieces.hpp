// SPDX-License-Identifier: MIT
/// Cuts faces and edges whose foot has no closed form into nearly flat pieces, each with a box that encloses it.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "kernels/brep/elements/elements.hpp"
#include "kernels/brep/tree/row_box.hpp"

namespace hapticd::brep {

/// [rad] (25 degrees) largest turn of the normals of a leaf that is no spline, or of the tangents of a piece of a
/// curve.
inline constexpr double kLeafTurn = 0.44;

struct BoxedLeaf {
  Leaf leaf;
  Eigen::AlignedBox3d box;
  OrientedBox oriented;
};
struct BoxedPiece {
  CurvePiece piece;
  Eigen::AlignedBox3d box;
  OrientedBox oriented;
};

/// [main] Adds the leaves of a spline, extrusion, revolution or offset face to `leaves`, without those that lie wholly
/// outside its trim.
void cutFace(const Geometry& geometry, std::uint32_t face, const FaceShape& shape, std::vector<BoxedLeaf>& leaves);

/// [main] Adds the pieces of an elliptic or spline edge to `pieces`.
void cutEdge(const Geometry& geometry, std::uint32_t edge, std::vector<BoxedPiece>& pieces);

}  // namespace hapticd::brep
