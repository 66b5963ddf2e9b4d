// SPDX-License-Identifier: MIT
/// Surfaces of Open CASCADE to records of a part, in their own parameters.
#pragma once
#include <Geom_Surface.hxx>

#include "cad_import/curves.hpp"

namespace hapticd::cad {

/// [main] Appends a surface as it is needed over [lo, hi]; a kind that a part does not have is approximated.
/// @throws Unkept
Kept addSurface(const Handle(Geom_Surface) & surface, const brep::Vector2& lo, const brep::Vector2& hi,
                brep::Part& part);

}  // namespace hapticd::cad
