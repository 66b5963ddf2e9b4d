// SPDX-License-Identifier: MIT
/// Selects the bodies of a part that are traced, with their poses.
#pragma once
#include <vector>

#include "kernels/brep/model/model.hpp"

namespace hapticd::brep {

/// [main] Returns the bodies to trace. @param feature_count becomes the number of features of all instances of the part
/// @throws std::invalid_argument if a name of the options is not one of the part (the message lists the names), or if
/// there is nothing to trace.
std::vector<Placement> placementsOf(const Part& part, const ModelOptions& options, std::uint32_t& feature_count);

}  // namespace hapticd::brep
