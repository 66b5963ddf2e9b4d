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

}  // namespace hapticd::brep
