// SPDX-License-Identifier: MIT
/// Which volumes closed shells bound. A file of loose faces does not say so.
#pragma once
#include <TopoDS_Shape.hxx>
#include <vector>

namespace hapticd::cad {

/// What the shells of a shape bound.
struct Volumes {
  std::vector<TopoDS_Shape> bodies;  ///< the solids; then, as one shape, what bounds no volume
  int solids = 0, cavities = 0;
  int doubtful = 0;  ///< closed shells that were left as they are, because the outside is not in front of their faces
};

/// [main] Makes solids of the closed shells of a shape that holds no solid. A closed shell inside another one is a
/// cavity of it, one inside a cavity is a solid again, and so on. If no shell bounds a volume, the only body is the
/// shape.
/// @param seconds time for testing what the shells bound; what was used is subtracted, and then they are not tested
Volumes volumesOf(const TopoDS_Shape& shape, double& seconds);

}  // namespace hapticd::cad
