// SPDX-License-Identifier: MIT
/// Finds faces that lie on one another.
#pragma once
#include <TopoDS_Shape.hxx>
#include <vector>

namespace hapticd::cad {

/// [main] Returns the numbers, from 0 in the order of TopExp_Explorer, of the faces that cover the same part of the
/// same surface as an earlier face with the same edges. There is no volume between two such faces, and a point beside
/// them is in front of the one and behind the other.
std::vector<int> doubledFaces(const TopoDS_Shape& shape);

}  // namespace hapticd::cad
