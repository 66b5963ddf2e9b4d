// SPDX-License-Identifier: MIT
/// Finds walls of a part that a press would go through.
#pragma once
#include <cstdint>
#include <optional>

#include "kernels/brep/model.hpp"

namespace hapticd {

struct ThinWall {
  double thickness = 0;       ///< [m] thickness of the wall along the face's normal
  std::uint32_t feature = 0;  ///< the face or triangle that was pressed
};

/// [main] Returns the thinnest wall of the part's solids through which a press of `depth` [m] goes, so that the probe
/// comes out behind a face that looks away from the pressed one. Returns nothing if there is no such wall, or if no
/// sample met it. Tries at most about 2000 points, spread over all faces and triangles.
std::optional<ThinWall> thinnestWall(const brep::Model& part, double depth);

}  // namespace hapticd
