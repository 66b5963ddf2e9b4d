// SPDX-License-Identifier: MIT
/// Repairs gaps and other defects of CAD bodies, and reports each repair.
#pragma once
#include <TopoDS_Shape.hxx>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

namespace hapticd::cad {

/// Colours of shapes; the key is the address of the shape's TShape.
using Colours = std::unordered_map<const void*, std::uint32_t>;

/// [main] Checks a shape and fixes it if it is not valid; sews loose faces; makes solids of closed shells. Returns the
/// bodies that the shape consists of: loose faces may bound several volumes. Each step adds a line to `steps`. Faces
/// that replace others inherit their colours.
/// @param body name of the shape, for these lines
std::vector<TopoDS_Shape> healed(const TopoDS_Shape& shape, const std::string& body, Colours& colours,
                                 std::vector<std::string>& steps);

/// [main] Returns true if the faces of a closed shape point inward, so that its volume is negative.
bool isInsideOut(const TopoDS_Shape& shape);

}  // namespace hapticd::cad
