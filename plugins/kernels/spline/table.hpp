// SPDX-License-Identifier: MIT
/// Power-basis coefficients of a surface, for its fast form of evaluation: one cell per knot span.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernels/spline/axis.hpp"
#include "kernels/spline/net.hpp"

namespace hapticd::spline {

/// How a surface or a curve is stored.
enum class Form : std::uint8_t {
  kTable,  ///< power-basis coefficients for each knot span; the fastest form
  kNet     ///< only control points (Cox-de Boor evaluation); the smallest form, exact to rounding for any weights
};

/// Largest allowed growth of rounding errors in a cell: the sum of the magnitudes of its terms, divided by the
/// magnitude of their sum. If a cell exceeds this, the surface is evaluated from its control net, whose terms are all
/// positive. A growth of 100 is an error of 2e-14 of the size of a span.
inline constexpr double kMaxTableGrowth = 100;

struct Table {
  /// The cells, u-major. Each cell has its local origin, then its coefficients; each of them takes tableStride()
  /// numbers. One more number follows the last cell, see TableKernel.
  std::vector<double> cells;
  int size_u = 0, size_v = 0;
  int shape = 0;                  ///< index into KernelSet::table
  std::ptrdiff_t stride = 0;      ///< distance from a cell to the next one along v, in numbers
  std::ptrdiff_t row_stride = 0;  ///< distance from a cell to the next one along u, in numbers
};

/// [main] Moves the expansion points of cells at collapsed sides onto these sides, so that tangents next to a pole keep
/// their relative precision.
void anchorAtCollapsedSides(const Net& net, Axis& u, Axis& v);

/// [main] Computes the Taylor coefficients of all cells about their origins. A curve is a surface of degree 0 along v.
/// Returns nothing if the power basis would lose digits.
std::optional<Table> makeTable(const Net& net, const Axis& u, const Axis& v);

}  // namespace hapticd::spline
