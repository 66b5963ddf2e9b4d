// SPDX-License-Identifier: MIT
/// Whether a point of the parameter plane lies inside the loops of a face.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kernels/brep/geometry.hpp"

namespace hapticd::brep {

/// A piece of a pcurve along which each of u and v either only grows or only falls.
struct TrimPiece {
  enum class Kind : std::uint32_t { kLine, kCircle, kOther };
  Eigen::Vector2d a, b;  ///< at t0 and t1; neighbours share them bit for bit, so that no way slips between
  float off_u, off_v;    ///< the curve keeps within these of the chord, seen along u and along v
  std::uint32_t curve;   ///< in curves2
  Kind kind;
  double t0, t1;
};

/// The loops of one face. Constant after construction.
/// Where the curves of a face's loops do not meet.
struct LoopGaps {
  int count = 0;
  double widest = 0;  ///< [m] in space, between the end of one curve and the start of the next
};

class Trim {
 public:
  Trim() = default;
  /// [main] The geometry must outlive it.
  Trim(const Geometry& geometry, const Face& face);

  /// [any] Even-odd rule. (u, v) in the window of the face's [lo, hi]; points on a loop count to either side.
  bool inside(double u, double v) const noexcept {
    if (!(u >= lo_[0] && u <= hi_[0] && v >= lo_[1] && v <= hi_[1])) return false;
    return cells_.empty() || insideGrid(u, v);
  }
  /// [any] The loops are just the box.
  bool rectangle() const noexcept { return cells_.empty(); }
  /// [any] True if a box of parameters has points inside the loops, or may have some.
  bool mayTouch(const Eigen::Array2d& lo, const Eigen::Array2d& hi) const noexcept;
  const Eigen::Array2d& lo() const noexcept { return lo_; }
  const Eigen::Array2d& hi() const noexcept { return hi_; }
  /// [any] The gaps that had to be closed.
  const LoopGaps& gaps() const noexcept { return gaps_; }
  std::size_t bytes() const noexcept;

 private:
  friend class TrimBuilder;
  bool insideGrid(double u, double v) const noexcept;
  bool crossesRight(const TrimPiece& piece, double v, double u) const noexcept;
  bool crossesAbove(const TrimPiece& piece, double u, double v) const noexcept;
  double crossing(const TrimPiece& piece, int axis, double at) const noexcept;
  bool crossesBeyond(const TrimPiece& piece, int axis, double at, double than) const noexcept;

  const Geometry* geometry_ = nullptr;
  Eigen::Array2d lo_{0, 0}, hi_{0, 0}, cell_{1, 1}, per_cell_{1, 1};  ///< box; size of a cell and its reciprocal
  std::int32_t count_u_ = 0, count_v_ = 0;
  LoopGaps gaps_;
  std::vector<TrimPiece> pieces_;
  /// By cell, row after row: where its pieces begin in of_cell_, and in the top bit whether its reference point is
  /// inside. One more at the end. Empty: the loops are the box.
  std::vector<std::uint32_t> cells_;
  std::vector<std::uint32_t> of_cell_;
};

}  // namespace hapticd::brep
