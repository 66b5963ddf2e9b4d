// SPDX-License-Identifier: MIT
/// Triangles without width, and points that differ only by rounding: the former look in a direction that only the
/// rounding of their corners decides, and both leave cracks in a surface that is closed.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh_import/mesh_edges.hpp"

namespace hapticd::importing {

using TriangleCorners = std::vector<std::array<std::uint32_t, 3>>;

/// A distance below this share of an edge is small beside that edge.
inline constexpr double kSmallShare = 0.01;

/// [any] Returns true if a triangle has no area: two of its corners are the same, or all three are on one line.
bool isEmptyTriangle(const std::vector<Eigen::Vector3d>& points, const std::array<std::uint32_t, 3>& corners);

/// [any] Returns how far [m] the coordinates of a mesh may be off, if they are rounded to single precision as those of
/// most files are: 5e-7 of the largest one, 4 steps of that precision.
double roundingOf(const std::vector<Eigen::Vector3d>& points, const TriangleCorners& corners);

/// [main] Removes triangles whose middle corner is on their longest edge, within the given distance [m] and a small
/// share of this edge, and cuts the neighbour across that edge in two at this corner. To leave such a triangle out
/// would open the surface there. Triangles without such a neighbour stay.
/// @return how many were removed
std::size_t takeInSlivers(const std::vector<Eigen::Vector3d>& points, double rounding, MeshTriangles& triangles);

/// [main] Joins points of free edges that differ by no more than the given distance [m], if that leaves fewer edges
/// free. Programs that write each triangle alone round such points in different directions. @return how many points
/// were joined
std::size_t joinFreePoints(const std::vector<Eigen::Vector3d>& points, double rounding, MeshTriangles& triangles);

}  // namespace hapticd::importing
