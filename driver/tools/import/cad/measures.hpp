// SPDX-License-Identifier: MIT
/// What shows only when a part is made ready for search: its box, the gaps that are closed then, and where it is open.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "kernels/part/part.hpp"

namespace hapticd::cad {

struct Measures {
  Eigen::AlignedBox3d box;         ///< [m] around all instances; empty if the part cannot be searched
  std::vector<std::string> notes;  ///< what loading the part says each time
};

/// [main] Loads a part as a scene does, and measures it.
Measures measured(const brep::Part& part);

/// [main] Returns a line for each body that is open: how many edges bound only one face, and where.
std::vector<std::string> openBodies(const brep::Part& part);

}  // namespace hapticd::cad
