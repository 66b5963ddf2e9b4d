// SPDX-License-Identifier: MIT
/// Which shells of a model bound one solid together, and which run into each other.
#pragma once
#include <vector>

#include "kernels/trace/model.hpp"

namespace hapticd::trace {

/// [main] The part of each shell, see Model::part(). By generalized winding numbers (Jacobson et al. 2013), which tell
/// inside from outside for shells with openings too. Not `complete`: there are so many shells that some were put into
/// the first part unseen.
std::vector<int> groupShells(const Model& model, bool& complete);

}  // namespace hapticd::trace
