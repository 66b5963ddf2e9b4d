// SPDX-License-Identifier: MIT
/// Cuts the loops of a face into pieces along which both parameters are monotone.
#pragma once
#include <vector>

#include "kernels/brep/geometry/trim.hpp"

namespace hapticd::brep {

/// [main] Returns the pieces of all loops. Neighbouring pieces share their ends. @param gaps counts the ends that were
/// so far apart that a straight line was put between them
std::vector<TrimPiece> trimPieces(const Geometry& geometry, const Face& face, LoopGaps& gaps);

}  // namespace hapticd::brep
