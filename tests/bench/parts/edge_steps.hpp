// SPDX-License-Identifier: MIT
/// How far the force's direction turns where a probe slides over the smooth edges of a part.
#pragma once
#include "kernels/brep/model.hpp"

namespace hapticd::bench {

/// Prints the largest steps beside the edges' dihedral angles.
void measureEdgeSteps(const brep::Model& model);

}  // namespace hapticd::bench
