// SPDX-License-Identifier: MIT
/// Boxes of faces and edges with a closed form.
#pragma once
#include <Eigen/Geometry>

#include "kernels/brep/elements.hpp"

namespace hapticd::brep {

/// [main] A box that holds a face whose surface is a plane, cylinder, cone, sphere or torus.
Eigen::AlignedBox3d faceBox(const FaceShape& face);

/// [main] The box of a straight or circular edge.
Eigen::AlignedBox3d edgeBox(const EdgeShape& edge, bool circle);

}  // namespace hapticd::brep
