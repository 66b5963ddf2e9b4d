// SPDX-License-Identifier: MIT
/// Limits the repairs that Open CASCADE's readers make while they read a shape.
#pragma once
#include <TopoDS_Shape.hxx>

namespace hapticd::cad {

/// [main] Returns the largest number of loops that any face of the shape has.
int mostLoops(const TopoDS_Shape& shape);

/// If a face has more loops than this, they are not compared with each other, because that takes minutes for thousands
/// of loops.
inline constexpr int kManyLoops = 200;

/// [main] Makes readers skip the search for loops that cross themselves in faces with many loops, because Open
/// CASCADE 7.6 copies all loops of the face for each loop. Call it once, before reading.
void limitShapeFixes();

}  // namespace hapticd::cad
