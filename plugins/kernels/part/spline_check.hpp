// SPDX-License-Identifier: MIT
/// Checks the knots and weights of splines directly in a part's numbers, by the rules of spline::validate().
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace hapticd::brep {

/// Largest absolute value of a parameter: the square of a product of two parameters stays finite.
inline constexpr double kWidestParameter = 1e30;

/// [main] Returns what is wrong with the knots of a B-spline of `count` control points, or "" if they are good.
std::string wrongKnots(std::span<const double> knots, std::uint32_t degree, std::uint32_t count);

/// [main] Returns what is wrong with the weights, or "" if they are good.
std::string wrongWeights(std::span<const double> weights);

}  // namespace hapticd::brep
