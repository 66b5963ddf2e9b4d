// SPDX-License-Identifier: MIT
/// Checks that the inside of a solid is behind its faces.
#pragma once
#include <TopoDS_Shape.hxx>

namespace hapticd::cad {

/// The number of faces that were tested, and the number of those that do not have the outside in front of them and the
/// inside behind.
struct SidesTried {
  int tried = 0, wrong = 0;
  /// True if so many faces are wrong that single badly chosen points cannot be the cause: then the faces do not bound
  /// one volume. If all faces are wrong, the solid is only inside out, which isInsideOut() finds.
  bool doubtful() const { return wrong > 1 && 10 * wrong >= tried && wrong < tried; }
};

/// [main] Takes a point on each of up to 40 faces, and asks Open CASCADE whether the points just in front of it and
/// just behind it are inside the solid. Open CASCADE answers by the crossings of a line with all faces. So this test
/// finds what a check of single faces cannot find: a valid face that is another part of its surface than the author of
/// the file meant.
/// @param seconds time after which no further face is tried
SidesTried trySides(const TopoDS_Shape& solid, double seconds);

}  // namespace hapticd::cad
