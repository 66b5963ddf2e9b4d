// SPDX-License-Identifier: MIT
#include "kernels/spline/cusp.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace hapticd::spline {
namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-9;  ///< share of a line's length: control points that are nearer count as one

/// The control points of a surface, line by line along an axis.
class Lines {
 public:
  Lines(const SurfaceData& data, int axis)
      : data_(data), axis_(axis), rows_(data.count(axis)), lines_(data.count(1 - axis)) {
    for (int line = 0; line < lines_; ++line) {
      double length = 0;
      for (int row = 1; row < rows_; ++row) length += (point(row, line) - point(row - 1, line)).norm();
      lengths_.push_back(length);
    }
  }

  int rows() const { return rows_; }
  int lines() const { return lines_; }
  std::size_t at(int row, int line) const {
    return static_cast<std::size_t>(axis_ == 0 ? row * lines_ + line : line * rows_ + row);
  }
  const Vector3d& point(int row, int line) const { return data_.points[at(row, line)]; }

  /// True if rows `first` to `last` coincide on a line that is longer than a point.
  bool coincideOn(int line, int first, int last) const {
    const double length = lengths_[static_cast<std::size_t>(line)];
    double apart = 0;
    for (int row = first + 1; row <= last; ++row)
      apart = std::max(apart, (point(row, line) - point(first, line)).norm());
    return length > 0 && apart <= kSame * length;
  }
  bool coincideOnAny(int first, int last) const {
    for (int line = 0; line < lines_; ++line)
      if (coincideOn(line, first, last)) return true;
    return false;
  }

 private:
  const SurfaceData& data_;
  int axis_, rows_, lines_;
  std::vector<double> lengths_;
};

/// True if the weights of each row are the same multiple of those of the first row, or there are none.
bool weightsAreAlike(const SurfaceData& data, const Lines& lines) {
  if (data.weights.empty()) return true;
  const auto weight = [&](int row, int line) { return data.weights[lines.at(row, line)]; };
  for (int row = 1; row < lines.rows(); ++row)
    for (int line = 1; line < lines.lines(); ++line) {
      const double expected = weight(row, 0) / weight(0, 0) * weight(0, line);
      if (!(std::abs(weight(row, line) - expected) <= 1e-12 * expected)) return false;
    }
  return true;
}

}  // namespace

std::vector<double> cuspKnots(const SurfaceData& data, int axis) {
  const std::vector<double>& knots = data.knots[static_cast<std::size_t>(axis)];
  const int degree = data.degree[static_cast<std::size_t>(axis)];
  const auto [lo, hi] = data.domain(axis);
  const Lines lines(data, axis);
  std::vector<double> cusps;
  if (degree < 2) return cusps;
  for (auto knot = std::lower_bound(knots.begin(), knots.end(), lo); knot != knots.end() && *knot <= hi;) {
    const auto next = std::upper_bound(knot, knots.end(), *knot);
    const auto multiplicity = static_cast<int>(next - knot), after = static_cast<int>(next - knots.begin());
    // The point at a knot depends on these rows. At a clamped end it is one row, and `degree` rows make the span
    // straight.
    int first = after - 1 - degree, last = after - 1 - multiplicity;
    if (multiplicity >= degree && *knot == lo) first = 0, last = degree - 1;
    if (multiplicity >= degree && *knot == hi) first = lines.rows() - degree, last = lines.rows() - 1;
    if (last > first && lines.coincideOnAny(std::max(first, 0), std::min(last, lines.rows() - 1)))
      cusps.push_back(*knot);
    knot = next;
  }
  return cusps;
}

void straighten(SurfaceData& piece, int axis) {
  const Lines lines(piece, axis);
  const int degree = lines.rows() - 1;
  if (degree < 2 || degree != piece.degree[static_cast<std::size_t>(axis)] || !weightsAreAlike(piece, lines)) return;
  const auto coincide = [&](int first, int last) {
    for (int line = 0; line < lines.lines(); ++line)
      if (!lines.coincideOn(line, first, last)) return false;
    return true;
  };
  if (!coincide(0, degree - 1) && !coincide(1, degree)) return;
  for (int line = 0; line < lines.lines(); ++line) {
    const Vector3d& from = lines.point(0, line);
    const Vector3d way = lines.point(degree, line) - from;
    for (int row = 1; row < degree; ++row) piece.points[lines.at(row, line)] = from + way * row / degree;
    if (piece.weights.empty()) continue;
    for (int row = 1; row <= degree; ++row) piece.weights[lines.at(row, line)] = piece.weights[lines.at(0, line)];
  }
}

bool isOnlyALine(const SurfaceData& piece, int axis) {
  const Lines lines(piece, axis);
  for (int line = 0; line < lines.lines(); ++line)
    for (int row = 1; row < lines.rows(); ++row)
      if (lines.point(row, line) != lines.point(0, line)) return false;
  return true;
}

}  // namespace hapticd::spline
