// SPDX-License-Identifier: MIT
/// Boxes of faces and edges with a closed form.
#pragma once
#include "kernels/brep/elements.hpp"
#include "kernels/brep/row_box.hpp"

namespace hapticd::brep {

/// [main] A box that holds a face whose surface is a plane, cylinder, cone, sphere or torus, along the axes that are
/// the rows of `frame`.
Eigen::AlignedBox3d faceBox(const FaceShape& face, const Eigen::Matrix3d& frame = Eigen::Matrix3d::Identity());
/// [main] The same, turned with the middle of the face.
TurnedBox turnedFaceBox(const FaceShape& face);

/// [main] The box of a straight or circular edge.
Eigen::AlignedBox3d edgeBox(const EdgeShape& edge, bool circle,
                            const Eigen::Matrix3d& frame = Eigen::Matrix3d::Identity());
/// [main] The same, turned with the middle of the edge.
TurnedBox turnedEdgeBox(const EdgeShape& edge, bool circle);

}  // namespace hapticd::brep
