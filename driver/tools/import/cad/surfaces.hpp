// SPDX-License-Identifier: MIT
/// Converts surfaces of Open CASCADE to records of a part, with the same parameters.
#pragma once
#include <Geom_Surface.hxx>

#include "cad_import/curves.hpp"

namespace hapticd::cad {

/// [main] Appends a surface, at least the range [lo, hi] of it. A kind of surface that a part does not have is
/// approximated.
/// @throws Unkept
Kept addSurface(const Handle(Geom_Surface) & surface, const brep::Vector2& lo, const brep::Vector2& hi,
                brep::Part& part);

}  // namespace hapticd::cad
