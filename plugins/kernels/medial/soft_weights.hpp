// SPDX-License-Identifier: MIT
/// Weights with which the corners of a cone or slab shape a felt surface. Where the mesh ends, their slope is zero.
///
/// A foot stops where a mesh ends: from there it moves only along the edge, or not at all. If the weights had a slope
/// across this edge, the slope of the dent would jump there. So these weights have zero slope at the end of the mesh.
/// One slab farther inside they are the barycentric weights. On an edge between two slabs they depend only on the two
/// corners of the edge, so that they do not jump from slab to slab.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/medial/medial_mesh.hpp"

namespace hapticd::medial {

struct CornerWeights {
  std::array<double, 3> value{};               ///< one per corner, from 0 to 1; their sum is 1
  std::array<double, 3> along_u{}, along_v{};  ///< derivatives of `value` over the foot's parameters
};

/// [rt] Returns weights with no slope at both ends of a cone, at its parameter t (0 to 1). The third corner has no
/// weight.
CornerWeights softOnCone(double t) noexcept;
/// [rt] Returns weights with no slope across any edge of a slab. @param centers centres of the spheres [m]
/// @param u, v barycentric weights of corners 1 and 2 at the foot
CornerWeights softOnSlab(const std::array<Eigen::Vector3d, 3>& centers, double u, double v) noexcept;

/// [main] Returns for each vertex 1 if the mesh ends there: at a rim, at the tip of a branch, at a join of parts, and
/// at a bend of more than 20 degrees. A foot may stop at such a vertex.
std::vector<uint8_t> endsOf(const MedialMesh& mesh);
/// [rt] Returns the weights at a foot: without slope near corners where the mesh ends, barycentric near the others, and
/// blended between them.
CornerWeights weightsTowardEnds(const MedialMesh& mesh, const std::vector<uint8_t>& ends, uint32_t element,
                                const Eigen::Array2d& parameter) noexcept;

}  // namespace hapticd::medial
