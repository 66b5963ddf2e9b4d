// SPDX-License-Identifier: MIT
/// Mends what a CAD program left open, and says what it did.
#pragma once
#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace hapticd::cad {

/// Colours, found by the TShape of what has them.
using Colours = std::unordered_map<const void*, std::uint32_t>;

/// [main] Checks a body and fixes it if it is not valid; sews loose faces; makes solids of closed shells. Each step
/// adds a line to `steps`. Faces that replace others inherit their colours.
/// @param body its name, for the lines
TopoDS_Shape healed(const TopoDS_Shape& shape, const std::string& body, Colours& colours,
                    std::vector<std::string>& steps);

/// [main] True if a closed shape has its outside inside, so that its volume is negative.
bool isInsideOut(const TopoDS_Shape& shape);

}  // namespace hapticd::cad
