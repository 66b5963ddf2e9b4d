// SPDX-License-Identifier: MIT
/// Triangles of zero area, and points that differ only by rounding: both leave cracks in a surface that is closed.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

using TriangleCorners = std::vector<std::array<std::uint32_t, 3>>;

/// [any] Returns true if a triangle has no area: two of its corners are the same, or all three are on one line.
bool isEmptyTriangle(const std::vector<Eigen::Vector3d>& points, const std::array<std::uint32_t, 3>& corners);

/// [main] Removes triangles whose middle corner is on their longest edge, and cuts the neighbour across that edge in
/// two at this corner. To leave such a triangle out would open the surface there. Triangles without such a neighbour
/// stay.
/// @return how many were removed
std::size_t takeInSlivers(const std::vector<Eigen::Vector3d>& points, TriangleCorners& corners);

/// [main] Joins points of free edges that differ by no more than single precision can tell (5e-7 of the largest
/// coordinate), if that leaves fewer edges free. Programs that write each triangle alone round such points in different
/// directions. @return how many points were joined
std::size_t joinFreePoints(const std::vector<Eigen::Vector3d>& points, TriangleCorners& corners);

}  // namespace hapticd::importing
