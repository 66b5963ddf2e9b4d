// SPDX-License-Identifier: MIT
/// Finds faces whose outline contradicts itself.
#pragma once
#include <TopoDS_Face.hxx>
#include <cstddef>

namespace hapticd::cad {

/// How far an edge of a face lies from its ends or from its curve on the face.
struct OutlineOff {
  std::size_t face = 0;    ///< number of the face
  double by = 0;           ///< [mm]
  bool at_vertex = false;  ///< true if it is off at the end of an edge
};

/// [main] Compares the edges of a face with their vertices and, at the same parameters, with their curves on the face.
/// Open CASCADE keeps these apart as far as the tolerance of an edge or a vertex, which it widens as far as a file
/// needs.
/// @param with_curves false if the part has other curves on the face, which were made from the edges
OutlineOff outlineOff(const TopoDS_Face& face, bool with_curves);

}  // namespace hapticd::cad
