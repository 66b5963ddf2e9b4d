// SPDX-License-Identifier: MIT
/// Finds out whether decimal commas are why a module refuses a list.
#pragma once
#include <string>

#include "description/scene.hpp"
#include "document/node.hpp"

namespace hapticd::diagnostics {

/// [main] Called for a list that the module of an arm refuses. Returns advice such as "; a comma separates two numbers:
/// write 0.2, not 0,2" if the list has zeros before whole numbers and is too long, which means that the module takes a
/// shorter one. Otherwise returns "". Makes instances in child processes; touches no hardware.
/// @param id the parameter, such as "arm.lengths"
std::string adviceOnCommas(const scene::Device& device, const std::string& id, const document::Node& list);

}  // namespace hapticd::diagnostics
