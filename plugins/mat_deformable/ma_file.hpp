// SPDX-License-Identifier: MIT
/// Medial meshes in the format of Q-MAT (Li et al. 2015) and its successors. The first line has the numbers of
/// vertices, edges and triangles. Then each of them has one line: `v x y z r`, `e i j` or `f i j k`. Indices count from
/// 0; # begins a comment line.
#pragma once
#include <string>

#include "kernels/medial/medial_mesh.hpp"

namespace hapticd {

/// [main] Reads the `text` of a file named `file`. Further columns are ignored, because some programs add flags there.
/// @throws ModelFileError with every problem found, one line each: `file:line: what, expected what`.
medial::MeshData parseMa(const std::string& text, const std::string& file);

}  // namespace hapticd
