// SPDX-License-Identifier: MIT
/// Converts surfaces of Open CASCADE to records of a part, with the same parameters.
#pragma once
#include <Geom_Surface.hxx>

#include "cad_import/curves.hpp"

namespace hapticd::cad {

/// [main] Appends a surface over at least the range [lo, hi]. If a part has no such kind of surface, it is
/// approximated.
/// @throws Unkept if the surface cannot be kept
Kept addSurface(const Handle(Geom_Surface) & surface, const brep::Vector2& lo, const brep::Vector2& hi,
                brep::Part& part);

}  // namespace hapticd::cad
