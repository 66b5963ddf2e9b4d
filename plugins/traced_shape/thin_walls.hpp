// SPDX-License-Identifier: MIT
/// Walls of a part that a press would go through.
#pragma once
#include <cstdint>
#include <optional>

#include "kernels/brep/model.hpp"

namespace hapticd {

struct ThinWall {
  double thickness = 0;       ///< [m] along the face's normal
  std::uint32_t feature = 0;  ///< the face or triangle that was pressed
};

/// [main] The thinnest wall of the part's solids that a press of `depth` [m] comes out of behind, at a face that looks
/// away from the pressed one; none: there is none, or no sample met it. Looks at some 2000 points spread over all faces
/// and triangles, at most.
std::optional<ThinWall> thinnestWall(const brep::Model& part, double depth);

}  // namespace hapticd
