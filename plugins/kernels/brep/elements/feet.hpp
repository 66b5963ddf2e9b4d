// SPDX-License-Identifier: MIT
/// Nearest points of single elements, in their body's frame.
#pragma once
#include "kernels/brep/elements/elements.hpp"

namespace hapticd::brep {

/// [main] Makes the shape of a face whose surface is a plane, cylinder, cone, sphere or torus.
FaceShape faceShape(const Geometry& geometry, std::uint32_t face);
/// [main] Makes the shape of an edge whose curve is a line or a circle.
EdgeShape edgeShape(const Part& part, const Edge& edge);

/// faceFoot(), lineFoot() and circleFoot() replace `hit` if their foot is nearer. They return the squared distance to
/// the element [m^2], or a lower bound if the exact value was not needed, or infinity if the element does not contain
/// the foot.

/// [rt] Foot of p on the base surface of a face, in closed form. On the base surface the distance has only one local
/// minimum. So a foot outside the trim can be ignored: the nearest point of the face is then on its edges.
double faceFoot(const FaceShape& face, const Eigen::Vector3d& p, Hit& hit) noexcept;
/// [rt] Nearest point of a straight edge.
double lineFoot(const EdgeShape& edge, const Eigen::Vector3d& p, Hit& hit) noexcept;
/// [rt] Nearest point of a circular edge.
double circleFoot(const EdgeShape& edge, const Eigen::Vector3d& p, Hit& hit) noexcept;
/// [rt] Outward unit normal at point q of a face with a closed form.
Eigen::Vector3d faceNormal(const FaceShape& face, const Eigen::Vector3d& q) noexcept;

}  // namespace hapticd::brep
