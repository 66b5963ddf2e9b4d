// SPDX-License-Identifier: MIT
/// Builds the pieces and the grid of a trim.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/brep/geometry/trim.hpp"
#include "kernels/brep/geometry/trim_grid.hpp"
#include "kernels/brep/geometry/trim_pieces.hpp"

namespace hapticd::brep {

using Eigen::Array2d;
using Eigen::Vector2d;

class TrimBuilder {
 public:
  TrimBuilder(const Geometry& geometry, const Face& face, Trim& trim) : face_(face), trim_(trim) {
    trim_.geometry_ = &geometry;
    trim_.lo_ = vec(face_.lo).array();
    trim_.hi_ = vec(face_.hi).array();
  }

  void run() {
    trim_.pieces_ = trimPieces(*trim_.geometry_, face_, trim_.gaps_);
    if (isBox()) {
      trim_.pieces_ = std::vector<TrimPiece>();  // "= {}" would keep the memory
      return;
    }
    setBox();
    fillGrid();
    for (const TrimPiece& p : trim_.pieces_) markRows(p);
    keepGrid();
  }

 private:
  /// True if every piece runs along a side of [lo, hi], or there are no pieces.
  bool isBox() const {
    if (face_.loop_count > 1) return false;
    const Array2d slack = 1e-12 * (trim_.hi_ - trim_.lo_);
    for (const TrimPiece& p : trim_.pieces_) {
      bool along = false;
      for (int axis = 0; axis < 2; ++axis)
        for (const double side : {trim_.lo_[axis], trim_.hi_[axis]})
          along = along || (std::abs(p.a[axis] - side) <= slack[axis] && std::abs(p.b[axis] - side) <= slack[axis]);
      if (!along || p.kind != TrimPiece::Kind::kLine) return false;
    }
    return true;
  }

  void setBox() {
    trim_.lo_.setConstant(std::numeric_limits<double>::infinity());
    trim_.hi_ = -trim_.lo_;
    for (const TrimPiece& p : trim_.pieces_) {
      trim_.lo_ = trim_.lo_.min(p.a.array()).min(p.b.array());
      trim_.hi_ = trim_.hi_.max(p.a.array()).max(p.b.array());
    }
    constexpr double kCellsPerPiece = 6, kFewest = 36, kMost = 65536;
    const double cells = std::clamp(kCellsPerPiece * static_cast<double>(trim_.pieces_.size()), kFewest, kMost);
    trim_.count_u_ = trim_.count_v_ = static_cast<int>(std::ceil(std::sqrt(cells)));
    const Array2d range = (trim_.hi_ - trim_.lo_).max(1e-300);
    trim_.cell_ = range / Array2d(trim_.count_u_, trim_.count_v_);
    trim_.per_cell_ = trim_.cell_.inverse();
  }

  int clampCell(int axis, double at) const {
    const double place = std::floor((at - trim_.lo_[axis]) * trim_.per_cell_[axis]);
    return static_cast<int>(std::clamp(place, 0.0, static_cast<double>(trim_.count_u_ - 1)));
  }

  std::size_t cellOf(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(trim_.count_u_) + static_cast<std::size_t>(i);
  }

  /// Calls use(column, row) for the cells that a piece may touch.
  template <class Use>
  void overCells(const TrimPiece& p, const Use& use) const {
    constexpr double kSlack = 1e-9;  // relative to the size of a cell
    const double slack_u = kSlack * trim_.cell_[0], slack_v = kSlack * trim_.cell_[1];
    const double low = std::min(p.a[1], p.b[1]), high = std::max(p.a[1], p.b[1]);
    const int last_row = clampCell(1, high + slack_v);
    for (int j = clampCell(1, low - slack_v); j <= last_row; ++j) {
      const double bottom = trim_.lo_[1] + trim_.cell_[1] * j;
      double u0 = p.a[0], u1 = p.b[0];
      if (low < high) {
        u0 = crossingAt(p, std::clamp(bottom - slack_v, low, high));
        u1 = crossingAt(p, std::clamp(bottom + trim_.cell_[1] + slack_v, low, high));
      }
      const int last = clampCell(0, std::max(u0, u1) + slack_u);
      for (int i = clampCell(0, std::min(u0, u1) - slack_u); i <= last; ++i) use(i, j);
    }
  }

  /// Returns u where a piece crosses the line at v; v may be at an end of the piece.
  double crossingAt(const TrimPiece& p, double v) const {
    if (v == p.a[1]) return p.a[0];
    if (v == p.b[1]) return p.b[0];
    if (p.kind != TrimPiece::Kind::kLine) return trim_.crossing(p, 1, v);
    return p.a[0] + (v - p.a[1]) / (p.b[1] - p.a[1]) * (p.b[0] - p.a[0]);
  }

  void fillGrid() {
    const std::size_t cells = cellOf(0, trim_.count_v_);
    cells_.assign(cells + 1, 0);
    for (const TrimPiece& p : trim_.pieces_) overCells(p, [&](int i, int j) { ++cells_[cellOf(i, j) + 1]; });
    for (std::size_t c = 0; c < cells; ++c) cells_[c + 1] += cells_[c];
    of_cell_.resize(cells_[cells]);
    std::vector<std::uint32_t> place(cells_.begin(), cells_.end() - 1);
    for (std::uint32_t k = 0; k < trim_.pieces_.size(); ++k)
      overCells(trim_.pieces_[k], [&](int i, int j) { of_cell_[place[cellOf(i, j)]++] = k; });
  }

  /// Marks which reference points are inside: each piece that crosses a row's height to the right of a reference point
  /// switches that point between inside and outside.
  void markRows(const TrimPiece& p) {
    const int last = std::min(clampCell(1, std::max(p.a[1], p.b[1])) + 1, trim_.count_v_ - 1);
    for (int j = std::max(clampCell(1, std::min(p.a[1], p.b[1])) - 1, 0); j <= last; ++j) {
      const double height = gridHeight(trim_.lo_[1], trim_.cell_[1], j);
      if ((p.a[1] <= height) == (p.b[1] <= height)) continue;
      for (int i = 0; i < trim_.count_u_; ++i) {
        if (!trim_.crossesRight(p, height, gridBorder(trim_.lo_[0], trim_.cell_[0], i))) break;
        cells_[cellOf(i, j)] ^= kInsideBit<std::uint32_t>;
      }
    }
  }

  void keepGrid() {
    constexpr std::size_t kNarrow = 0x8000;
    if (of_cell_.size() >= kNarrow || trim_.pieces_.size() >= kNarrow) {
      trim_.wide_.reserve(cells_.size() + of_cell_.size());
      trim_.wide_.assign(cells_.begin(), cells_.end());
      trim_.wide_.insert(trim_.wide_.end(), of_cell_.begin(), of_cell_.end());
      return;
    }
    trim_.narrow_.reserve(cells_.size() + of_cell_.size());
    for (const std::uint32_t cell : cells_) {
      const bool inside = (cell & kInsideBit<std::uint32_t>) != 0;
      trim_.narrow_.push_back(static_cast<std::uint16_t>(inside ? cell | kInsideBit<std::uint16_t> : cell));
    }
    for (const std::uint32_t piece : of_cell_) trim_.narrow_.push_back(static_cast<std::uint16_t>(piece));
  }

  const Face& face_;
  Trim& trim_;
  std::vector<std::uint32_t> cells_, of_cell_;  ///< the two parts of the grid, see Trim::wide_
};

Trim::Trim(const Geometry& geometry, const Face& face) {
  TrimBuilder(geometry, face, *this).run();
}

}  // namespace hapticd::brep
