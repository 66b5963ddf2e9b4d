// SPDX-License-Identifier: MIT
/// Weights of the corners of a cone or slab, by which a felt surface yields. Where the mesh ends they lose their slope.
///
/// A foot is held where a mesh ends: it then moves along the edge alone, or not at all. Weights with a slope across the
/// edge would end that slope of the dent in one step. Those here have none there; a slab farther inside they are the
/// barycentric ones. On an edge between two slabs they are a matter of its own two corners, so that they do not jump.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "kernels/medial/medial_mesh.hpp"

namespace hapticd::medial {

struct CornerWeights {
  std::array<double, 3> value{};               ///< one per corner, from 0 to 1; their sum is 1
  std::array<double, 3> along_u{}, along_v{};  ///< derivatives with respect to the foot's parameters
};

/// [rt] Weights with no slope across any edge, on a cone at t, 0 to 1. Its third corner has no weight.
CornerWeights softOnCone(double t) noexcept;
/// [rt] The same on a slab of these centres [m] where corners 1 and 2 have the barycentric weights u and v.
CornerWeights softOnSlab(const std::array<Eigen::Vector3d, 3>& centers, double u, double v) noexcept;

/// [main] For each vertex, whether the mesh ends there: at a rim, at the tip of a branch, where parts join, and at
/// bends of more than 20 degrees. A foot may be held there.
std::vector<uint8_t> endsOf(const MedialMesh& mesh);
/// [rt] The weights at a foot: soft at corners where the mesh ends, barycentric at the others, blended between.
CornerWeights weightsTowardEnds(const MedialMesh& mesh, const std::vector<uint8_t>& ends, uint32_t element,
                                const Eigen::Array2d& parameter) noexcept;

}  // namespace hapticd::medial
