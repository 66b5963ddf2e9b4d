// SPDX-License-Identifier: MIT
/// Nearest points of single elements, in their body's frame.
#pragma once
#include "kernels/brep/elements.hpp"

namespace hapticd::brep {

/// [main] The shape of a face whose surface is a plane, cylinder, cone, sphere or torus.
FaceShape faceShape(const Geometry& geometry, std::uint32_t face);
/// [main] The shape of an edge whose curve is a line or a circle.
EdgeShape edgeShape(const Part& part, const Edge& edge);

/// All of them replace `hit` where they are nearer, and return a lower bound of the squared distance [m^2] of the
/// element: the distance itself where it was computed, infinity if the element does not contain the foot.

/// [rt] Foot of p on the base surface of a face, in closed form. The base surface has one local minimum of the distance
/// alone, so a foot outside the trim can be ignored: the nearest point of the face is then on its edges.
double faceFoot(const FaceShape& face, const Eigen::Vector3d& p, Hit& hit) noexcept;
/// [rt] Nearest point of a straight edge.
double lineFoot(const EdgeShape& edge, const Eigen::Vector3d& p, Hit& hit) noexcept;
/// [rt] Nearest point of a circular edge.
double circleFoot(const EdgeShape& edge, const Eigen::Vector3d& p, Hit& hit) noexcept;
/// [rt] Outward unit normal of a face with a closed form at its point q.
Eigen::Vector3d faceNormal(const FaceShape& face, const Eigen::Vector3d& q) noexcept;

}  // namespace hapticd::brep
