// SPDX-License-Identifier: MIT
/// Edges along which solids touch.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh_import/mesh_edges.hpp"

namespace hapticd::importing {

/// [main] True if a triangle runs from the point of the smaller index to that of the larger one along an edge of it.
inline bool runsForward(const std::vector<std::array<std::uint32_t, 3>>& corners, const MeshEdge& edge) {
  return corners[edge.code / 4][edge.code % 4] < corners[edge.code / 4][(edge.code % 4 + 1) % 3];
}

/// [main] True if inside and outside alternate around an edge, from each of its triangles to the next. Then the solid
/// is known around the edge, also if four or more triangles meet there, and the sum of their normals points away from
/// it.
/// @param first, end range of the edge in `edges`
bool solidsTouch(const std::vector<Eigen::Vector3d>& points, const std::vector<std::array<std::uint32_t, 3>>& corners,
                 const std::vector<MeshEdge>& edges, std::size_t first, std::size_t end);

}  // namespace hapticd::importing
