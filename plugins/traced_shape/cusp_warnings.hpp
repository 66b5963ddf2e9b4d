// SPDX-License-Identifier: MIT
/// Finds folds within a surface at which the tracer cannot be sure of its foot points.
#pragma once
#include <cstddef>

#include "document.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd {

/// [main] Warns if as many rows of control points as the degree coincide or nearly do, the surface therefore folds
/// there, and the kernel cannot make the spans beside the fold regular (spline::hasDoubtfulCusp()).
void warnOfCusps(const spline::SurfaceData& surface, std::size_t index, Problems& odd);

}  // namespace hapticd
