/// Which shells of a model bound one solid together, and which run into each other.
#pragma once
#include <vector>

#include "kernels/trace/model.hpp"

namespace hapticd::trace {

/// [main] The part of each shell, see Model::part(). By generalized winding numbers (Jacobson et al. 2013), which tell
/// inside from outside for shells with openings too. Models of very many shells make one part.
std::vector<int> groupShells(const Model& model);

/// [main] Model::hasGaps() of each part. The normals of a closed surface, weighted by area, sum up to nothing; what
/// they sum up to is the area of the openings.
std::vector<char> findGaps(const Model& model);

}  // namespace hapticd::trace
