// SPDX-License-Identifier: MIT
/// Measures how far the direction of the force turns when a probe slides over the smooth edges of a part.
#pragma once
#include "kernels/brep/model/model.hpp"

namespace hapticd::bench {

/// Prints the largest steps of the direction, compared with the dihedral angles of the edges.
void measureEdgeSteps(const brep::Model& model);

}  // namespace hapticd::bench
