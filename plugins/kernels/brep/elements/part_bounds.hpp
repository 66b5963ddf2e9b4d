// SPDX-License-Identifier: MIT
/// Boxes around faces and edges whose foot has a closed form.
#pragma once
#include "kernels/brep/elements/elements.hpp"
#include "kernels/brep/tree/row_box.hpp"

namespace hapticd::brep {

/// [main] Returns a box that encloses a face whose surface is a plane, cylinder, cone, sphere or torus. The sides of
/// the box are along the rows of `frame`.
Eigen::AlignedBox3d faceBox(const FaceShape& face, const Eigen::Matrix3d& frame = Eigen::Matrix3d::Identity());
/// [main] Returns a box that encloses the face, with the axes of the face's middle.
OrientedBox orientedFaceBox(const FaceShape& face);

/// [main] Returns a box that encloses a straight or circular edge, along the rows of `frame`.
Eigen::AlignedBox3d edgeBox(const EdgeShape& edge, bool circle,
                            const Eigen::Matrix3d& frame = Eigen::Matrix3d::Identity());
/// [main] Returns a box that encloses the edge, with the axes of the edge's middle.
OrientedBox orientedEdgeBox(const EdgeShape& edge, bool circle);

}  // namespace hapticd::brep
