// SPDX-License-Identifier: MIT
/// Cuts faces and edges without a closed form into flat pieces, each with a box that holds it.
#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "kernels/brep/elements.hpp"
#include "kernels/brep/row_box.hpp"

namespace hapticd::brep {

struct BoxedLeaf {
  Leaf leaf;
  Eigen::AlignedBox3d box;
  TurnedBox turned;
};
struct BoxedPiece {
  CurvePiece piece;
  Eigen::AlignedBox3d box;
  TurnedBox turned;
};

/// [main] The leaves of a spline, extrusion, revolution or offset face that its trim does not leave out whole.
void cutFace(const Geometry& geometry, std::uint32_t face, const FaceShape& shape, std::vector<BoxedLeaf>& leaves);

/// [main] The pieces of an elliptic or spline edge.
void cutEdge(const Geometry& geometry, std::uint32_t edge, std::vector<BoxedPiece>& pieces);

}  // namespace hapticd::brep
