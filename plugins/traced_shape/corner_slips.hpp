// SPDX-License-Identifier: MIT
/// Finds corners of surfaces that miss the corner of a neighbour, because a coordinate is mistyped.
#pragma once
#include <set>
#include <utility>

#include "document.hpp"
#include "model_file.hpp"

namespace hapticd {

/// [main] Adds a warning at the control point for each pair of surfaces with sides that agree in all control points but
/// one, if there is a sign that this one is mistyped: the same side has more control points that agree; or only one
/// coordinate differs, by a power of ten; or with the neighbour's corner the surface becomes a parallelogram. Sides
/// that are free on purpose show none of these signs.
/// @return the pairs of surfaces that were reported, the smaller index first
std::set<std::pair<std::size_t, std::size_t>> warnOfCornerSlips(const ModelFile& file, Problems& odd);

}  // namespace hapticd
