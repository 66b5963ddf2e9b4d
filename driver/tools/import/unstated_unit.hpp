// SPDX-License-Identifier: MIT
/// Says what was assumed of a file that states no unit, such as a mesh.
#pragma once
#include <string>

#include "import/bezier_import.hpp"

namespace hapticd::importing {

/// [any] Returns a line that says how to read the file in the usual units; "" if its size was chosen.
/// @param largest [m] extent of what was imported
std::string unstatedUnit(const Placement& placement, double largest);

}  // namespace hapticd::importing
