// SPDX-License-Identifier: MIT
/// What Open CASCADE's readers repair of a shape while they read it.
#pragma once
#include <TopoDS_Shape.hxx>

namespace hapticd::cad {

/// [main] The largest number of loops that a face of the shape has.
int mostLoops(const TopoDS_Shape& shape);

/// In a face with more loops than this, loops are not compared with each other, which takes minutes for thousands.
inline constexpr int kManyLoops = 200;

/// [main] Lets readers leave out the search for loops that cross themselves in faces with many loops: Open CASCADE 7.6
/// copies all loops of the face for each. Call it once, before reading.
void limitShapeFixes();

}  // namespace hapticd::cad
