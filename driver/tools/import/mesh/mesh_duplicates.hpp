// SPDX-License-Identifier: MIT
/// Triangles that have the same three corners as another one.
#pragma once
#include <cstddef>

#include "mesh_import/mesh_edges.hpp"

namespace hapticd::importing {

/// How many triangles were left out.
struct LeftOut {
  std::size_t duplicates = 0;    ///< one of their kind was kept
  std::size_t back_to_back = 0;  ///< they lay back to back on one another in pairs, and both were left out
};

/// What becomes of a sheet of pairs that lie back to back and hang on a surface, with an outer border of their own.
enum class Flange { kKeepOneSide, kLeaveOut };

/// [main] Leaves out triangles that have the same three corners as another one. Of such triangles one is kept. Pairs
/// that lie back to back between two bodies, as a wall does, are both left out if this joins the bodies along whole
/// edges: to keep one would leave edges of three triangles.
LeftOut leaveOutDuplicates(MeshTriangles& triangles, Flange flange);

}  // namespace hapticd::importing
