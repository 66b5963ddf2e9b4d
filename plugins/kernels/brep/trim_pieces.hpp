// SPDX-License-Identifier: MIT
/// The loops of a face cut into pieces along which both parameters are monotone.
#pragma once
#include <vector>

#include "kernels/brep/trim.hpp"

namespace hapticd::brep {

/// [main] All pieces of all loops. Neighbours share their ends; `gaps` tells of those so far apart that a line had to
/// be put between.
std::vector<TrimPiece> trimPieces(const Geometry& geometry, const Face& face, LoopGaps& gaps);

}  // namespace hapticd::brep
