// SPDX-License-Identifier: MIT
#include "kernels/brep/geometry/trim.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/brep/geometry/trim_grid.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Array2d;

/// True if a piece from a to b crosses `at`. The interval is half-open, so that a line through the joint of two pieces
/// crosses exactly one of them.
bool spans(double a, double b, double at) noexcept {
  return (a <= at) != (b <= at);
}

/// True if v grows with u along a piece.
bool rises(const TrimPiece& piece) noexcept {
  return (piece.b[0] > piece.a[0]) == (piece.b[1] > piece.a[1]);
}

}  // namespace

/// Returns the other coordinate of the point where a piece crosses the line `axis` = at, by Newton's method on the
/// parameter, kept inside a bracket.
double Trim::crossing(const TrimPiece& piece, int axis, double at) const noexcept {
  if (piece.kind == TrimPiece::Kind::kCircle) {
    const Curve2& c = geometry_->part().curves2[piece.curve];
    const double r2 = c.x[0] * c.x[0] + c.x[1] * c.x[1];
    const auto i = static_cast<std::size_t>(axis), j = 1 - i;
    const double d = at - c.o[i], half = std::sqrt(std::max(r2 - d * d, 0.0));
    // a monotone piece lies on one side of the center
    const double middle = 0.5 * (piece.a[1 - axis] + piece.b[1 - axis]);
    return middle >= c.o[j] ? c.o[j] + half : c.o[j] - half;
  }
  constexpr int kMostSteps = 60;
  const bool rising = piece.b[axis] > piece.a[axis];
  double low = piece.t0, high = piece.t1;
  const double share = (at - piece.a[axis]) / (piece.b[axis] - piece.a[axis]);
  double t = low + (high - low) * std::clamp(share, 0.0, 1.0);
  PlanePoint where{};
  for (int i = 0; i < kMostSteps; ++i) {
    where = geometry_->planeCurve(piece.curve, t);
    const double off = where.c[axis] - at;
    if (off == 0) break;
    ((off < 0) == rising ? low : high) = t;
    double next = t - off / where.c1[axis];
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next <= low || next >= high || std::abs(next - t) <= 1e-16 * std::max(std::abs(low), std::abs(high))) break;
    t = next;
  }
  return std::clamp(where.c[1 - axis], std::min(piece.a[1 - axis], piece.b[1 - axis]),
                    std::max(piece.a[1 - axis], piece.b[1 - axis]));
}

/// True if a piece crosses the line `axis` = at where its other coordinate is greater than `than`. The piece is
/// monotone, so this coordinate lies between its values at the ends of the bracket, and a few points of the curve are
/// usually enough.
bool Trim::crossesBeyond(const TrimPiece& piece, int axis, double at, double than) const noexcept {
  if (piece.kind == TrimPiece::Kind::kCircle) return crossing(piece, axis, at) > than;
  constexpr int kMostSteps = 60;
  const int other = 1 - axis;
  const double least = std::min(piece.a[other], piece.b[other]), most = std::max(piece.a[other], piece.b[other]);
  const bool rising = piece.b[axis] > piece.a[axis];
  double ends[2] = {piece.t0, piece.t1}, beside[2] = {piece.a[other], piece.b[other]};
  const double share = (at - piece.a[axis]) / (piece.b[axis] - piece.a[axis]);
  double t = ends[0] + (ends[1] - ends[0]) * std::clamp(share, 0.0, 1.0);
  int last = -1;
  for (int i = 0; i < kMostSteps; ++i) {
    const PlanePoint where = geometry_->planeCurve(piece.curve, t);
    const double off = where.c[axis] - at, here = std::clamp(where.c[other], least, most);
    if (off == 0) return here > than;
    const int end = (off < 0) == rising ? 0 : 1;
    ends[end] = t;
    beside[end] = here;
    if (than < std::min(beside[0], beside[1])) return true;
    if (than >= std::max(beside[0], beside[1])) return false;
    const double step = -off / where.c1[axis];
    // two steps in a row moved the same end of the bracket: step twice as far, to reach the other side of the root
    double next = t + (end == last ? 2 * step : step);
    if (!(next > ends[0] && next < ends[1])) next = 0.5 * (ends[0] + ends[1]);
    if (next <= ends[0] || next >= ends[1]) return here > than;
    last = end;
    t = next;
  }
  return 0.5 * (beside[0] + beside[1]) > than;
}

/// True if a piece passes to the right of a point in its box. Both directions of crossing are decided by this one
/// answer. If each were computed along its own axis, then rounding could give two contradicting answers for a piece
/// that is nearly parallel to an axis. All points of the cell at that u or v would then be on the wrong side.
bool Trim::passesRight(const TrimPiece& piece, double u, double v) const noexcept {
  const Eigen::Vector2d way = piece.b - piece.a;
  if (piece.kind == TrimPiece::Kind::kLine) {
    const double side = way[0] * (v - piece.a[1]) - way[1] * (u - piece.a[0]);
    return way[1] > 0 ? side > 0 : side < 0;
  }
  const int axis = piece.axis;
  const double along = axis == 0 ? v : u, beside = axis == 0 ? u : v, curve = piece.besideAt(piece.shareAt(along));
  const bool beyond = std::abs(curve - beside) > static_cast<double>(piece.off)
                          ? curve > beside
                          : crossesBeyond(piece, 1 - axis, along, beside);
  return axis == 0 ? beyond : beyond != rises(piece);
}

/// True if a piece that crosses the line v = const crosses it to the right of u.
bool Trim::crossesRight(const TrimPiece& piece, double v, double u) const noexcept {
  if (u < std::min(piece.a[0], piece.b[0])) return true;
  if (u >= std::max(piece.a[0], piece.b[0])) return false;
  return passesRight(piece, u, v);
}

/// True if a piece that crosses the line u = const crosses it above v.
bool Trim::crossesAbove(const TrimPiece& piece, double u, double v) const noexcept {
  if (v < std::min(piece.a[1], piece.b[1])) return true;
  if (v >= std::max(piece.a[1], piece.b[1])) return false;
  return passesRight(piece, u, v) != rises(piece);
}

/// Counts the crossings of the loops with a path from the point to the right border of its cell, and along the border
/// to the reference point. For the reference point it is known whether it is inside.
template <class Index>
bool Trim::insideGrid(const std::vector<Index>& grid, double u, double v) const noexcept {
  constexpr auto kCount = static_cast<Index>(~kInsideBit<Index>);
  const int i = std::min(static_cast<int>((u - lo_[0]) * per_cell_[0]), count_u_ - 1);
  const int j = std::min(static_cast<int>((v - lo_[1]) * per_cell_[1]), count_v_ - 1);
  const auto cell = static_cast<std::size_t>(j) * static_cast<std::size_t>(count_u_) + static_cast<std::size_t>(i);
  bool in = (grid[cell] & kInsideBit<Index>) != 0;
  const double border = gridBorder(lo_[0], cell_[0], i), height = gridHeight(lo_[1], cell_[1], j);
  const Index* const of_cell = grid.data() + cellCount() + 1;
  const std::size_t end = grid[cell + 1] & kCount;
  for (std::size_t k = grid[cell] & kCount; k < end; ++k) {
    const TrimPiece& piece = pieces_[of_cell[k]];
    if (spans(piece.a[1], piece.b[1], v)) in ^= crossesRight(piece, v, u) != crossesRight(piece, v, border);
    if (spans(piece.a[0], piece.b[0], border))
      in ^= crossesAbove(piece, border, v) != crossesAbove(piece, border, height);
  }
  return in;
}
template bool Trim::insideGrid(const std::vector<std::uint32_t>&, double, double) const noexcept;
template bool Trim::insideGrid(const std::vector<std::uint16_t>&, double, double) const noexcept;

/// True if a cell has pieces, or lies inside the loops.
template <class Index>
bool Trim::isUsed(const std::vector<Index>& grid, std::size_t cell) const noexcept {
  return grid[cell] != (grid[cell + 1] & ~kInsideBit<Index>);
}

bool Trim::mayTouch(const Array2d& lo, const Array2d& hi) const noexcept {
  if ((hi < lo_).any() || (lo > hi_).any()) return false;
  if (rectangle()) return true;
  const Array2d most = Array2d(count_u_ - 1, count_v_ - 1);
  const Array2d first = ((lo - lo_) * per_cell_).floor().max(0).min(most);
  const Array2d last = ((hi - lo_) * per_cell_).floor().max(0).min(most);
  for (int j = static_cast<int>(first[1]); j <= static_cast<int>(last[1]); ++j)
    for (int i = static_cast<int>(first[0]); i <= static_cast<int>(last[0]); ++i) {
      const auto cell = static_cast<std::size_t>(j * count_u_ + i);
      if (narrow_.empty() ? isUsed(wide_, cell) : isUsed(narrow_, cell)) return true;
    }
  return false;
}

std::size_t Trim::bytes() const noexcept {
  return pieces_.size() * sizeof(TrimPiece) + wide_.size() * sizeof wide_[0] + narrow_.size() * sizeof narrow_[0];
}

}  // namespace hapticd::brep
