// SPDX-License-Identifier: MIT
/// The loops of a face cut into pieces along which both parameters are monotone.
#pragma once
#include <vector>

#include "kernels/brep/trim.hpp"

namespace hapticd::brep {

/// [main] All pieces of all loops. Neighbours share their ends; `gaps` counts those so wide that a line had to be put
/// between.
std::vector<TrimPiece> trimPieces(const Geometry& geometry, const Face& face, int& gaps);

}  // namespace hapticd::brep
