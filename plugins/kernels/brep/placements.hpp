// SPDX-License-Identifier: MIT
/// Which bodies of a part are placed where, and under which names.
#pragma once
#include <string>
#include <vector>

#include "kernels/brep/model.hpp"

namespace hapticd::brep {

/// [main] The bodies to trace, and how many features they have. `wanted`: see ModelOptions::instance.
/// @throws std::invalid_argument if `wanted` names nothing or there is nothing to trace; the message lists the names.
std::vector<Placement> placementsOf(const Part& part, const std::string& wanted, std::uint32_t& feature_count);

/// [main] The names from the outermost assembly down to an instance, with slashes; its number where it has none.
std::string instancePath(const Part& part, std::uint32_t instance);

/// [main] Instance and face of a feature in words, as "bolt: face 3 'head'"; features count over all instances of the
/// file. "": there is no such feature.
std::string featureName(const Part& part, std::uint32_t feature);

}  // namespace hapticd::brep
