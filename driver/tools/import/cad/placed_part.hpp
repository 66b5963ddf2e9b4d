// SPDX-License-Identifier: MIT
/// Scales, turns and moves a part that was built from a CAD file.
#pragma once
#include <Eigen/Geometry>

#include "kernels/part/part.hpp"

namespace hapticd::cad {

/// How the user wants the part to lie.
struct Placement {
  double scale = 1;     ///< factor on top of the unit of the file
  double fit = 0;       ///< [m] largest extent of the part; replaces `scale`; 0 if not used
  bool center = false;  ///< true moves the middle of the part's box to the origin
  char up = 'y';        ///< axis of the file that points up; the world's is y

  bool moves() const { return scale != 1 || fit > 0 || center || up != 'y'; }
};

/// [main] Scales all lengths of a part. The parameters of surfaces and curves keep their values, because the axes carry
/// the unit.
void scalePart(brep::Part& part, double scale);

/// [main] Places a part, and notes in its source what was done. @param box the box around the part before
void placePart(brep::Part& part, const Placement& placement, const Eigen::AlignedBox3d& box);

}  // namespace hapticd::cad
