// SPDX-License-Identifier: MIT
/// Checks that the inside of a solid is behind its faces.
#pragma once
#include <TopoDS_Shape.hxx>

namespace hapticd::cad {

/// The faces that were tried, and those that do not have the outside in front of them and the inside behind.
struct SidesTried {
  int tried = 0, wrong = 0;
  /// True if this is no matter of single points: the faces do not bound one volume.
  bool doubtful() const { return wrong > 1 && 10 * wrong >= tried && wrong < tried; }
};

/// [main] Takes a point on each of up to 40 faces, and asks Open CASCADE on which side of the solid its neighbours are,
/// before and behind the face. It goes by the crossings of a line with all faces, so it finds what a check of single
/// faces cannot: a face that is valid, but is another part of its surface than the writer of the file meant.
/// @param seconds time after which no further face is tried
SidesTried trySides(const TopoDS_Shape& solid, double seconds);

}  // namespace hapticd::cad
