// SPDX-License-Identifier: MIT
/// One parameter direction of a spline: its knots and spans, and the look-up of the span that contains a parameter.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

/// A parameter interval on which the spline is one polynomial: a knot span, or a part of one.
struct Cell {
  double lo = 0, end = 0;  ///< lo <= t < end
  double origin = 0;       ///< parameter about which the table's coefficients are expanded
  std::int32_t knot = 0;   ///< index of the knot at the low end of the span
  std::int32_t span = 0;   ///< index of the cell's span in the domain
};

class Axis {
 public:
  Axis() = default;
  /// [main] @param knots the knots, which must have passed validateKnots()
  Axis(int degree, const std::vector<double>& knots);

  /// [any] Finds the cell that contains t. @param hint in: the cell to try first (any value is allowed); out: the index
  /// of the cell. Returns t moved into the domain; NaN becomes the low end.
  double locate(double t, std::int32_t& hint) const noexcept {
    const auto h = static_cast<std::size_t>(static_cast<std::uint32_t>(hint));
    if (h < cells_.size() && cells_[h].lo <= t && t < cells_[h].end) [[likely]] {
      return t;
    }
    return search(t, hint);
  }
  const Cell& cell(std::int32_t index) const noexcept { return cells_[static_cast<std::size_t>(index)]; }
  KnotWindow window(const Cell& cell) const noexcept {
    return {degree_, knots_.data() + cell.knot, reciprocals_.data() + cell.span * (degree_ * (degree_ + 1) / 2)};
  }

  int degree() const noexcept { return degree_; }
  int count() const noexcept { return static_cast<int>(knots_.size()) - degree_ - 1; }
  std::span<const double> breaks() const noexcept { return breaks_; }
  const std::vector<Cell>& cells() const noexcept { return cells_; }
  const std::vector<double>& knots() const noexcept { return knots_; }
  std::size_t bytes() const noexcept;

  /// [main] Changes the point about which the table's coefficients of end cells are expanded: `low` moves that of the
  /// first cell to the low end of the domain, `high` that of the last cell to the high end. Otherwise it is the middle
  /// of the cell. If both are true and there is a single cell, the cell is halved.
  void anchor(bool low, bool high);

  /// [main] Frees the memory that only window(), count() and knots() use. These functions must not be called
  /// afterwards.
  void forgetKnots();

 private:
  double search(double t, std::int32_t& hint) const noexcept;

  int degree_ = 0;
  std::vector<Cell> cells_;
  std::vector<double> knots_, breaks_, reciprocals_;
};

}  // namespace hapticd::spline
