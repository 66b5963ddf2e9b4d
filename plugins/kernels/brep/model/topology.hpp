// SPDX-License-Identifier: MIT
/// How the faces of a part meet at its edges and corners.
#pragma once
#include <vector>

#include "kernels/brep/model/model.hpp"

namespace hapticd::brep {

/// [main] Sets kind and angle of every edge whose kind is unknown, from the normals of its faces at nine points.
void classifyEdges(const Geometry& geometry, std::vector<Edge>& edges);

/// [main] Returns the normal at each vertex: the mean of the normals of the faces around it, weighted by their angles
/// there.
std::vector<CornerNormal> vertexNormals(const Geometry& geometry);

/// [main] Returns the normal at each point of the meshes: the mean over its triangles, weighted by their angles there.
std::vector<CornerNormal> pointNormals(const Part& part);

/// [main] Computes interpolated normals for meshes with a smooth_angle. @param of_corner becomes the index of the
/// normal of each corner of each triangle, or kNone if the corner is not smoothed; stays empty if no mesh is smoothed
/// @param normals becomes the normals. Corners share a normal if the edges between their triangles bend by less than
/// smooth_angle.
void smoothNormals(const Part& part, std::vector<std::uint32_t>& of_corner, std::vector<Eigen::Vector3f>& normals);

/// [any] Outward unit normal of a coedge's face at parameter t of the coedge.
Eigen::Vector3d coedgeNormal(const Geometry& geometry, const Coedge& coedge, double t) noexcept;

/// [any] True if a triangle and the one beyond its edge k are one flat face: their normals agree, and no third triangle
/// has this edge.
bool isFlatOver(const Part& part, std::uint32_t triangle, std::uint32_t k) noexcept;

/// [any] Unit normal of a triangle, or 0 if the triangle has no area.
Eigen::Vector3d triangleNormal(const Part& part, const Triangle& triangle) noexcept;

}  // namespace hapticd::brep
