// SPDX-License-Identifier: MIT
/// B-spline basis functions of one span: the small tools of set-up code.
#pragma once
#include <array>
#include <span>

#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {

/// [any] Index k of the non-empty span with knots[k] <= t < knots[k + 1]; the last one for t at the end of the domain,
/// the first or last for t outside it. Source: Piegl & Tiller A2.1.
int findSpan(std::span<const double> knots, int degree, double t) noexcept;

/// [any] The degree + 1 basis functions N_{span-degree}.. N_{span} at t. Source: Piegl & Tiller A2.2.
void basisFunctions(std::span<const double> knots, int degree, int span, double t,
                    std::array<double, kMaxDegree + 1>& basis) noexcept;

}  // namespace hapticd::spline
