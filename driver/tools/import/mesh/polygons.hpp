// SPDX-License-Identifier: MIT
/// Cuts polygons of mesh files into triangles.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace hapticd::importing {

/// [main] Cuts a polygon into triangles and appends them to `corners`. If all triangles of the fan from its first
/// corner have the same sense, the polygon is cut into that fan. Any other one is cut ear by ear, so that a concave
/// polygon keeps its own area. Corners that repeat the one before are left out.
/// @param polygon indices into `points`, one for each corner
/// @return false if the polygon is concave and has so many corners that cutting it takes too long
bool cutPolygon(const std::vector<Eigen::Vector3d>& points, std::vector<std::uint32_t> polygon,
                std::vector<std::array<std::uint32_t, 3>>& corners);

inline constexpr const char* kPolygonTooLarge =
    "the polygon is concave and has so many corners that cutting it takes too long; "
    "expected triangles: export the mesh again, triangulated";

}  // namespace hapticd::importing
