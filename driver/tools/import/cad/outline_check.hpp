// SPDX-License-Identifier: MIT
/// Finds faces whose outline contradicts itself.
#pragma once
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

namespace hapticd::cad {

/// Faces whose edges lie elsewhere than their ends or than their curves on the face.
struct OutlinesOff {
  int faces = 0;
  int worst_face = 0;      ///< number of the face that is off most, from 0 in the order of TopExp_Explorer
  double worst = 0;        ///< [mm]
  bool at_vertex = false;  ///< true if it is off at the end of an edge
};

/// [main] Compares each edge with its curve on each face at the same parameters, and its ends with its vertices. Open
/// CASCADE keeps these apart as far as the tolerance of an edge or a vertex, which it widens as far as a file needs.
/// @param allowed [mm] differences up to this are not counted
OutlinesOff outlinesOff(const TopoDS_Shape& shape, double allowed);

}  // namespace hapticd::cad
