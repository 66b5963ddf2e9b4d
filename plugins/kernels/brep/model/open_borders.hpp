// SPDX-License-Identifier: MIT
/// Finds where the bodies of a part are open: the borders that their free edges form.
#pragma once
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "kernels/part/part.hpp"

namespace hapticd::brep {

/// Free edges that hang together.
struct OpenBorder {
  std::size_t edges = 0;
  std::uint32_t body = 0;
  /// [m] Around the edges, where the only instance of the body is; in the body's frame if it has more.
  Eigen::AlignedBox3d box;
};

/// [main] Returns the borders of all bodies, the largest of each body first.
std::vector<OpenBorder> openBorders(const Part& part);

/// [main] Says where the largest of some borders are, such as "around (10, 0, 2) mm, 5 mm wide; around ...". The
/// coordinates are those of the boxes.
std::string placesOf(const std::vector<OpenBorder>& borders);

}  // namespace hapticd::brep
