// SPDX-License-Identifier: MIT
#include "kernels/spline/axis.hpp"

#include <cmath>

namespace hapticd::spline {

Axis::Axis(int degree, const std::vector<double>& knots) : degree_(degree), knots_(knots) {
  for (int k = degree; k < count(); ++k) {
    const double lo = knots[static_cast<std::size_t>(k)], hi = knots[static_cast<std::size_t>(k) + 1];
    if (lo == hi) continue;
    cells_.push_back({lo, hi, lo + (hi - lo) / 2, k, static_cast<std::int32_t>(breaks_.size())});
    breaks_.push_back(lo);
    const double* local = knots_.data() + k;
    for (int j = 1; j <= degree; ++j) {
      for (int r = 0; r < j; ++r) reciprocals_.push_back(1 / (local[r + 1] - local[r + 1 - j]));
    }
  }
  breaks_.push_back(knots[static_cast<std::size_t>(count())]);
  cells_.back().end = std::nextafter(breaks_.back(), INFINITY);  // the last cell includes the end of the domain
}

void Axis::anchor(bool low, bool high) {
  const Cell first = cells_.front();
  if (low && high && cells_.size() == 1 && first.origin > first.lo) {
    cells_.front().end = first.origin;
    cells_.push_back(first);
    cells_.back().lo = first.origin;
  }
  if (low) cells_.front().origin = breaks_.front();
  if (high) cells_.back().origin = breaks_.back();
}

void Axis::forgetKnots() {
  knots_ = std::vector<double>();  // "= {}" would keep the memory
  reciprocals_ = std::vector<double>();
  cells_.shrink_to_fit();
  breaks_.shrink_to_fit();
}

double Axis::search(double t, std::int32_t& hint) const noexcept {
  if (!(t > breaks_.front())) t = breaks_.front();
  if (t > breaks_.back()) t = breaks_.back();
  const auto above = std::upper_bound(cells_.begin() + 1, cells_.end(), t,
                                      [](double value, const Cell& cell) { return value < cell.lo; });
  hint = static_cast<std::int32_t>(above - cells_.begin()) - 1;
  return t;
}

std::size_t Axis::bytes() const noexcept {
  return cells_.capacity() * sizeof(Cell) +
         (knots_.capacity() + breaks_.capacity() + reciprocals_.capacity()) * sizeof(double);
}

}  // namespace hapticd::spline
