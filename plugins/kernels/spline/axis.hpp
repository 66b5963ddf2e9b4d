// SPDX-License-Identifier: MIT
/// One parameter direction of a spline: its knots, its spans, and which span holds a parameter.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/spline/kernel.hpp"

namespace hapticd::spline {

/// A parameter interval with one polynomial: a knot span, or a part of one.
struct Cell {
  double lo = 0, end = 0;  ///< lo <= t < end
  double origin = 0;       ///< where table coefficients are expanded
  std::int32_t knot = 0;   ///< index of the knot at the low end of the span
  std::int32_t span = 0;   ///< which span of the domain this is, or is a part of
};

class Axis {
 public:
  Axis() = default;
  /// [main] For valid knots.
  Axis(int degree, const std::vector<double>& knots);

  /// [any] Puts into `hint` the index of the cell that holds t, looked for first where it says (any value), and
  /// returns t moved into the domain; not-a-number goes to its low end.
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

  /// [main] Expands the table coefficients of the first or last cell at that end of the domain rather than in its
  /// middle; a single cell with both ends asked for is halved.
  void anchor(bool low, bool high);

 private:
  double search(double t, std::int32_t& hint) const noexcept;

  int degree_ = 0;
  std::vector<Cell> cells_;
  std::vector<double> knots_, breaks_, reciprocals_;
};

}  // namespace hapticd::spline
