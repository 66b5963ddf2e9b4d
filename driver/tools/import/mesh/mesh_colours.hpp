// SPDX-License-Identifier: MIT
/// Colours of the triangles of a mesh.
#pragma once
#include <cstdint>

#include "kernels/part/part.hpp"
#include "mesh_import/mesh_repair.hpp"

namespace hapticd::importing {

/// [any] Returns a colour as a word, 255 at its top. @param red, green, blue from 0 to 1; others are moved to the
/// nearer end. Returns 0, no colour, if one of them is not a number.
std::uint32_t colourWord(double red, double green, double blue);

/// [main] Adds the colours of a repaired mesh to a part that has its triangles at its end. A corner has the colour that
/// the nearest corner of its triangle has in the file. @param scale metres per unit of the file
/// @return how many triangles have a colour
std::size_t addColours(const MeshFile& file, double scale, const RepairedMesh& mesh, brep::Part& part);

}  // namespace hapticd::importing
