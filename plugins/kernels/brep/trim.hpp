// SPDX-License-Identifier: MIT
/// Tells whether a point of the parameter plane lies inside the loops of a face.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kernels/brep/geometry.hpp"

namespace hapticd::brep {

/// A piece of a pcurve along which u is monotone and v is monotone.
struct TrimPiece {
  enum class Kind : std::uint32_t { kLine, kCircle, kOther };
  Eigen::Vector2d a, b;  ///< ends at t0 and t1; neighbouring pieces share them bit for bit, so that there is no gap
  float off_u, off_v;    ///< largest deviation of the curve from its chord along u and along v
  std::uint32_t curve;   ///< index in Part::curves2
  Kind kind;
  double t0, t1;
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
    return cells_.empty() || insideGrid(u, v);
  }
  /// [any] True if the loops are the sides of the box [lo, hi], or there are none.
  bool rectangle() const noexcept { return cells_.empty(); }
  /// [any] True if a box of parameters has, or may have, points inside the loops.
  bool mayTouch(const Eigen::Array2d& lo, const Eigen::Array2d& hi) const noexcept;
  const Eigen::Array2d& lo() const noexcept { return lo_; }
  const Eigen::Array2d& hi() const noexcept { return hi_; }
  /// [any] Returns the gaps that had to be closed by straight lines.
  const LoopGaps& gaps() const noexcept { return gaps_; }
  std::size_t bytes() const noexcept;

 private:
  friend class TrimBuilder;
  bool insideGrid(double u, double v) const noexcept;
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
  /// For each cell, row after row: the index of its first piece in of_cell_. The top bit is set if the cell's reference
  /// point is inside. One more entry marks the end. Empty if the loops are the box.
  std::vector<std::uint32_t> cells_;
  std::vector<std::uint32_t> of_cell_;
};

}  // namespace hapticd::brep
