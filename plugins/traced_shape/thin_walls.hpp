// SPDX-License-Identifier: MIT
/// Finds walls of a part that are so thin that a probe goes through them when it presses.
#pragma once
#include <cstdint>
#include <optional>

#include "kernels/brep/model/model.hpp"

namespace hapticd {

struct ThinWall {
  double thickness = 0;       ///< [m] thickness of the wall along the face's normal
  std::uint32_t feature = 0;  ///< the face or triangle that was pressed
};

/// [main] Finds the thinnest wall of the part's solids that a press of `depth` [m] goes through: the probe is then
/// outside again, behind a face whose normal points away from the pressed face. Returns nothing if there is no such
/// wall, or if no sample point lies on it. Tries at most about 2000 points, spread over all faces and triangles.
/// @param least [m] walls that are thinner than this are passed over
std::optional<ThinWall> thinnestWall(const brep::Model& part, double depth, double least = 0);

}  // namespace hapticd
