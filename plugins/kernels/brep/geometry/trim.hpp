// SPDX-License-Identifier: MIT
/// Decides whether a point of the parameter plane lies inside the loops of a face.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/brep/geometry/geometry.hpp"

namespace hapticd::brep {

/// A piece of a pcurve along which u is monotone and v is monotone. It is near a parabola: one coordinate as a function
/// of the other one. A piece of kind kLine is straight and has no parabola.
struct TrimPiece {
  enum class Kind : std::uint16_t { kLine, kCircle, kOther };
  Eigen::Vector2d a, b;  ///< ends at t0 and t1; neighbouring pieces share them bit for bit, so that there is no gap
  double t0, t1;
  float bend;           ///< the parabola's distance from the chord in the middle, times 4
  float off;            ///< largest deviation of the curve from the parabola, along `axis`
  std::uint32_t curve;  ///< index in Part::curves2
  Kind kind;
  std::uint16_t axis;  ///< the coordinate that is the parabola's value: 0 for u, 1 for v; the other one runs more

  /// [any] Returns how far along the piece the other coordinate has the value `at`, from 0 to 1.
  double shareAt(double at) const noexcept {
    const double run = b[1 - axis] - a[1 - axis];
    return run == 0 ? 0.5 : std::clamp((at - a[1 - axis]) / run, 0.0, 1.0);
  }
  /// [any] Returns the parabola's value at a share of the piece.
  double besideAt(double share) const noexcept {
    return a[axis] + share * (b[axis] - a[axis]) + share * (1 - share) * static_cast<double>(bend);
  }
};

/// Gaps between consecutive curves of a face's loops.
struct LoopGaps {
  int count = 0;
  double widest = 0;  ///< [m] largest distance in space between the end of one curve and the start of the next
};

/// The loops of one face. Constant after construction.
class Trim {
 public:
  Trim() = default;
  /// [main] The geometry must outlive this object.
  Trim(const Geometry& geometry, const Face& face);

  /// [any] True if (u, v) is inside the loops, by the even-odd rule. Periodic parameters must lie in the face's [lo,
  /// hi]. A point on a loop may count as inside or outside.
  bool inside(double u, double v) const noexcept {
    if (!(u >= lo_[0] && u <= hi_[0] && v >= lo_[1] && v <= hi_[1])) return false;
    return rectangle() || insideGrid(u, v);
  }
  /// [any] True if the loops are the sides of the box [lo, hi], or there are none.
  bool rectangle() const noexcept { return count_u_ == 0; }
  /// [any] True if a box of parameters has, or may have, points inside the loops.
  bool mayTouch(const Eigen::Array2d& lo, const Eigen::Array2d& hi) const noexcept;
  const Eigen::Array2d& lo() const noexcept { return lo_; }
  const Eigen::Array2d& hi() const noexcept { return hi_; }
  /// [any] Returns the gaps that had to be closed by straight lines.
  const LoopGaps& gaps() const noexcept { return gaps_; }
  std::size_t bytes() const noexcept;

 private:
  friend class TrimBuilder;
  bool insideGrid(double u, double v) const noexcept {
    return narrow_.empty() ? insideGrid(wide_, u, v) : insideGrid(narrow_, u, v);
  }
  template <class Index>
  bool insideGrid(const std::vector<Index>& grid, double u, double v) const noexcept;
  template <class Index>
  bool isUsed(const std::vector<Index>& grid, std::size_t cell) const noexcept;
  std::size_t cellCount() const noexcept {
    return static_cast<std::size_t>(count_u_) * static_cast<std::size_t>(count_v_);
  }
  bool passesRight(const TrimPiece& piece, double u, double v) const noexcept;
  bool crossesRight(const TrimPiece& piece, double v, double u) const noexcept;
  bool crossesAbove(const TrimPiece& piece, double u, double v) const noexcept;
  double crossing(const TrimPiece& piece, int axis, double at) const noexcept;
  bool crossesBeyond(const TrimPiece& piece, int axis, double at, double than) const noexcept;

  const Geometry* geometry_ = nullptr;
  /// Box of the loops; size of a cell, and its reciprocal.
  Eigen::Array2d lo_{0, 0}, hi_{0, 0}, cell_{1, 1}, per_cell_{1, 1};
  std::int32_t count_u_ = 0, count_v_ = 0;
  LoopGaps gaps_;
  std::vector<TrimPiece> pieces_;
  /// The grid. First for each cell, row after row: how many pieces the cells before it have; the top bit is set if the
  /// cell's reference point is inside. One more entry marks the end. Then the pieces of all cells, as indices in
  /// pieces_. Only one of the two is used: `narrow_` if the numbers fit.
  std::vector<std::uint32_t> wide_;
  std::vector<std::uint16_t> narrow_;
};

}  // namespace hapticd::brep
