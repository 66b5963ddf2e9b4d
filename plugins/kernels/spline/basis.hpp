// SPDX-License-Identifier: MIT
/// B-spline basis functions of one span, for code that runs at load time.
#pragma once
#include <array>
#include <span>

#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// [any] Returns the index k of the non-empty span with knots[k] <= t < knots[k + 1]. At the end of the domain this is
/// the last non-empty span; outside the domain it is the first or the last. Source: Piegl & Tiller A2.1.
int findSpan(std::span<const double> knots, int degree, double t) noexcept;

/// [any] Computes the degree + 1 basis functions N_{span-degree} to N_{span} at t. Source: Piegl & Tiller A2.2.
void basisFunctions(std::span<const double> knots, int degree, int span, double t,
                    std::array<double, kMaxDegree + 1>& basis) noexcept;

}  // namespace hapticd::spline
