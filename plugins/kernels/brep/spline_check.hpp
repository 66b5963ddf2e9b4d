// SPDX-License-Identifier: MIT
/// The rules of knots and weights in a part's numbers. They are those of spline::validate(), without its copies.
#pragma once
#include <cstdint>
#include <span>
#include <string>

namespace hapticd::brep {

/// Largest parameter: the squares of products of two stay finite.
inline constexpr double kWidestParameter = 1e30;

/// [main] What is wrong with the knots of a B-spline of `count` control points; empty: nothing.
std::string wrongKnots(std::span<const double> knots, std::uint32_t degree, std::uint32_t count);

/// [main] What is wrong with weights; empty: nothing.
std::string wrongWeights(std::span<const double> weights);

}  // namespace hapticd::brep
