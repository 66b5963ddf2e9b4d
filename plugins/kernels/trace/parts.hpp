// SPDX-License-Identifier: MIT
/// Finds out which shells of a model together bound one solid, and which shells overlap.
#pragma once
#include <vector>

#include "kernels/trace/model.hpp"

namespace hapticd::trace {

/// [main] Returns the part of each shell, see Model::part(). Uses generalized winding numbers (Jacobson et al. 2013),
/// which distinguish inside from outside even for shells with openings. `complete` becomes false if there are so many
/// shells or triangles that some shells were not tested against all others.
std::vector<int> groupShells(const Model& model, bool& complete);

}  // namespace hapticd::trace
