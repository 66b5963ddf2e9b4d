// SPDX-License-Identifier: MIT
/// Repairs the triangles of one body.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh_import/mesh_edges.hpp"
#include "mesh_import/mesh_part.hpp"

namespace hapticd::importing {

/// Triangles that agree with their neighbours and face outward, if they are closed.
struct RepairedMesh {
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<std::array<std::uint32_t, 3>> corners;
  std::vector<MeshEdge> edges;
  std::vector<std::uint32_t> from;  ///< the triangle of the file from which each triangle comes
};

/// [main] Repairs a mesh, and writes into the report what was done.
RepairedMesh repaired(const MeshFile& mesh, const MeshOptions& options, MeshReport& report);

}  // namespace hapticd::importing
