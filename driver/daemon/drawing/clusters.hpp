// SPDX-License-Identifier: MIT
/// Groups of places that a coarser drawing joins to one: those in the same cube of a grid whose surface faces the same
/// direction. (Vertex clustering: Rossignac and Borrel, Multi-resolution 3D approximations, 1993. The direction keeps
/// the two sides of a thin wall apart.)
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "drawing/welded_mesh.hpp"

namespace hapticd::drawing {

struct Clusters {
  std::vector<std::uint32_t> of;         ///< cluster of each place
  std::size_t count = 0;                 ///< number of clusters
  std::vector<std::uint32_t> triangles;  ///< triangles that stay: their corners are in three clusters, and no earlier
                                         ///< triangle joins the same three in the same order
  std::vector<std::uint32_t> lone;       ///< triangles that stay as they are, since no other would draw their clusters

  std::size_t drawn() const { return triangles.size() + lone.size(); }
};

/// [main] Returns the clusters of a grid of cubes. @param cell [m] side of a cube
Clusters clustersOf(const WeldedMesh& mesh, double cell);

/// [main] Returns the clusters of a fine grid that leaves at most `most` triangles. @param most at least 100: 46 are
/// left in the worst case, where all of the model is in one cube
Clusters finestClusters(const WeldedMesh& mesh, std::size_t most);

}  // namespace hapticd::drawing
