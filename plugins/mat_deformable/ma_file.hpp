// SPDX-License-Identifier: MIT
/// Medial meshes in the format of Q-MAT (Li et al. 2015) and its successors: a line with the numbers of vertices, edges
/// and triangles, then a line each: `v x y z r`, `e i j`, `f i j k`; indices count from 0, # begins a comment line.
#pragma once
#include <string>

#include "kernels/medial/medial_mesh.hpp"

namespace hapticd {

/// [main] `text` of a file named `file`. Columns beyond those above are ignored: some programs add flags there.
/// @throws ModelFileError with every problem found, `file:line: what, expected what`, a line each.
medial::MeshData parseMa(const std::string& text, const std::string& file);

}  // namespace hapticd
