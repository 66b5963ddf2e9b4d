// SPDX-License-Identifier: MIT
/// Power-basis coefficients of a surface, a cell a span: the fast form of evaluation.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "kernels/spline/axis.hpp"
#include "kernels/spline/net.hpp"

namespace hapticd::spline {

/// Sum of the magnitudes of a cell's terms over the size of what they add up to: how many times a rounding error grows.
/// A cell above this keeps the control net, whose terms are all positive. 100 roundings are 2e-14 of a span.
inline constexpr double kMaxTableGrowth = 100;

struct Table {
  std::vector<Quad> cells;  ///< u-major; each: local origin, then coefficients
  int size_u = 0, size_v = 0;
  int shape = 0;                  ///< index into KernelSet::table
  std::ptrdiff_t stride = 0;      ///< from a cell to the next along v, in quads
  std::ptrdiff_t row_stride = 0;  ///< and along u
};

/// [main] Moves expansion points to collapsed sides, so that tangents next to a pole keep their relative precision.
void anchorAtCollapsedSides(const Net& net, Axis& u, Axis& v);

/// [main] Taylor coefficients of all cells about their origins; nothing if the power basis would lose digits.
std::optional<Table> makeTable(const Net& net, const Axis& u, const Axis& v);

}  // namespace hapticd::spline
