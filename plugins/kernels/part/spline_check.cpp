// SPDX-License-Identifier: MIT
#include "kernels/part/spline_check.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/spline/surface_data.hpp"

namespace hapticd::brep {

std::string wrongKnots(std::span<const double> knots, std::uint32_t degree, std::uint32_t count) {
  if (degree < 1 || degree > static_cast<std::uint32_t>(spline::kMaxDegree))
    return "degree " + std::to_string(degree) + ", expected 1 to " + std::to_string(spline::kMaxDegree);
  if (count <= degree)
    return std::to_string(count) + " control points, expected more than the degree " + std::to_string(degree);
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const std::string where = "knot " + std::to_string(i);
    if (!(std::abs(knots[i]) <= kWidestParameter)) return where + " is not a finite number up to 1e30";
    if (i == 0 || knots[i] == knots[i - 1]) continue;
    if (knots[i] < knots[i - 1]) return where + " is less than the one before it, expected knots that never decrease";
    if (knots[i] - knots[i - 1] < spline::kNarrowestSpan)
      return where + " is less than 1e-100 above the one before it, expected equal knots or a wider span";
  }
  if (!(knots[degree] < knots[count])) return "the domain is empty, expected its first knot to be less than its last";
  const std::size_t order = std::size_t{degree} + 1;
  for (std::size_t i = order; i + order + 1 < knots.size(); ++i)
    if (knots[i] == knots[i + order] && knots[i] > knots[order - 1] && knots[i] < knots[knots.size() - order])
      return "knot " + std::to_string(i) + " occurs more than degree + 1 times, expected at most degree + 1";
  return "";
}

std::string wrongWeights(std::span<const double> weights) {
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (!(weights[i] > 0) || !std::isfinite(weights[i]))
      return "weight " + std::to_string(i) + " is not a positive finite number";
  const auto [least, most] = std::minmax_element(weights.begin(), weights.end());
  return *most / spline::kMaxWeightRatio > *least ? "the weights differ by a factor of more than 1e100, expected less"
                                                  : "";
}

}  // namespace hapticd::brep
