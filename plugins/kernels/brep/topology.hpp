// SPDX-License-Identifier: MIT
/// What meets at the edges and corners of a part.
#pragma once
#include <vector>

#include "kernels/brep/model.hpp"

namespace hapticd::brep {

/// [main] Finds kind and angle of every edge whose kind is unknown, from the normals of its faces at nine points.
void classifyEdges(const Geometry& geometry, std::vector<Edge>& edges);

/// [main] Normals about the vertices: the faces around each, weighted by their angle there.
std::vector<CornerNormal> vertexNormals(const Geometry& geometry);

/// [main] The same for the points of meshes.
std::vector<CornerNormal> pointNormals(const Part& part);

/// [main] For meshes with a smooth_angle: which normal each corner of each triangle has (kNone: none is smoothed), and
/// the normals. Corners share one where the edges between their triangles bend by less than the angle.
void smoothNormals(const Part& part, std::vector<std::uint32_t>& of_corner, std::vector<Eigen::Vector3f>& normals);

/// [any] Outward unit normal of a coedge's face at parameter t of the coedge.
Eigen::Vector3d coedgeNormal(const Geometry& geometry, const Coedge& coedge, double t) noexcept;

/// [any] Unit normal of a triangle; 0 if it has no area.
Eigen::Vector3d triangleNormal(const Part& part, const Triangle& triangle) noexcept;

}  // namespace hapticd::brep
