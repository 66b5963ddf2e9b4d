// SPDX-License-Identifier: MIT
/// Edges that are so short that only rounding keeps their ends apart.
#pragma once
#include "mesh_import/mesh_slivers.hpp"

namespace hapticd::importing {

/// [main] Joins the ends of edges that are no longer than the given distance [m], and short beside the other edges of
/// their two triangles. Both triangles vanish: they are needles whose direction only rounding decides. Edges stay where
/// this would change how the surface hangs together.
/// @return how many points were joined with another one
std::size_t joinCoincident(const std::vector<Eigen::Vector3d>& points, double rounding, MeshTriangles& triangles);

}  // namespace hapticd::importing
