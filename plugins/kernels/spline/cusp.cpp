// SPDX-License-Identifier: MIT
#include "kernels/spline/cusp.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace hapticd::spline {
namespace {

using Eigen::Vector3d;

constexpr double kSame = 1e-8;  ///< share of a line's length: control points that are nearer count as one
constexpr double kNear =
    3e-3;  ///< share of a line's length: rows that are nearer on all lines bend the surface sharply

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

  bool isPoint(int line) const { return !(lengths_[static_cast<std::size_t>(line)] > 0); }
  /// True if rows `first` to `last` are within a share of the line's length, and the line is longer than a point.
  bool coincideOn(int line, int first, int last, double share = kSame) const {
    double apart = 0;
    for (int row = first + 1; row <= last; ++row)
      apart = std::max(apart, (point(row, line) - point(first, line)).norm());
    return !isPoint(line) && apart <= share * lengths_[static_cast<std::size_t>(line)];
  }
  bool coincideOnAny(int first, int last) const {
    for (int line = 0; line < lines_; ++line)
      if (coincideOn(line, first, last)) return true;
    return false;
  }
  /// True if rows `first` to `last` are within a share of the length of each line that is longer than a point.
  bool coincideOnAll(int first, int last, double share) const {
    bool any = false;
    for (int line = 0; line < lines_; ++line) {
      if (isPoint(line)) continue;
      if (!coincideOn(line, first, last, share)) return false;
      any = true;
    }
    return any;
  }

 private:
  const SurfaceData& data_;
  int axis_, rows_, lines_;
  std::vector<double> lengths_;
};

using Corners = std::array<Vector3d, 4>;  ///< of a quadrilateral, in order around it

Corners cornersOf(const Lines& lines) {
  const int row = lines.rows() - 1, line = lines.lines() - 1;
  return {lines.point(0, 0), lines.point(row, 0), lines.point(row, line), lines.point(0, line)};
}

bool isFlatAndConvex(const Corners& corner) {
  const Vector3d one = corner[2] - corner[0], other = corner[3] - corner[1];
  const Vector3d normal = one.cross(other).stableNormalized();
  const double slack = kSame * (one.norm() + other.norm());
  if (!(std::abs(normal.dot(corner[1] - corner[0])) <= slack && std::abs(normal.dot(one)) <= slack)) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d to = corner[(i + 1) % 4] - corner[i], next = corner[(i + 2) % 4] - corner[(i + 1) % 4];
    if (!(to.cross(next).dot(normal) >= 0)) return false;
  }
  return true;
}

/// True if a point lies in a flat, convex quadrilateral, and on those of its edges where it should.
bool isWithin(const Corners& corner, const Vector3d& point, const std::array<bool, 4>& on) {
  const Vector3d one = corner[2] - corner[0], other = corner[3] - corner[1];
  const Vector3d normal = one.cross(other).stableNormalized();
  const double slack = kSame * (one.norm() + other.norm());
  if (!(std::abs(normal.dot(point - corner[0])) <= slack)) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d edge = (corner[(i + 1) % 4] - corner[i]).stableNormalized();
    const double inward = edge.cross(point - corner[i]).dot(normal);
    if (!(inward >= -slack) || (on[i] && !(inward <= slack))) return false;
  }
  return true;
}

/// True if the piece is linear across the axis, and the first and last rows bound flat, convex quadrilaterals. Then the
/// weights move points only within the quadrilaterals.
bool consistsOfFlatQuads(const SurfaceData& piece, int axis, const Lines& lines) {
  if (piece.degree[static_cast<std::size_t>(1 - axis)] != 1) return false;
  const int end = lines.rows() - 1;
  for (int line = 0; line + 1 < lines.lines(); ++line)
    if (!isFlatAndConvex(
            {lines.point(0, line), lines.point(end, line), lines.point(end, line + 1), lines.point(0, line + 1)}))
      return false;
  return true;
}

/// Spaces the rows evenly between the first and the last row.
void evenOut(SurfaceData& piece, const Lines& lines) {
  const int end = lines.rows() - 1;
  double first = 0, last = 0;  // sums of weights: all weights of one row may be multiplied
  for (int line = 0; line < lines.lines() && !piece.weights.empty(); ++line) {
    first += piece.weights[lines.at(0, line)];
    last += piece.weights[lines.at(end, line)];
  }
  for (int line = 0; line < lines.lines(); ++line) {
    const Vector3d from = lines.point(0, line), way = lines.point(end, line) - from;
    if (!piece.weights.empty()) piece.weights[lines.at(end, line)] *= first / last;
    for (int row = 1; row < end; ++row) {
      double share = static_cast<double>(row) / end;
      if (!piece.weights.empty()) {
        const double to = piece.weights[lines.at(end, line)];
        double& weight = piece.weights[lines.at(row, line)];
        weight = std::lerp(piece.weights[lines.at(0, line)], to, share);
        share *= to / weight;
      }
      piece.points[lines.at(row, line)] = from + way * share;
    }
  }
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
    first = std::max(first, 0), last = std::min(last, lines.rows() - 1);
    if (last > first && (lines.coincideOnAny(first, last) || lines.coincideOnAll(first, last, kNear)))
      cusps.push_back(*knot);
    knot = next;
  }
  return cusps;
}

bool weightsAreAlike(const SurfaceData& data, int axis) {
  if (data.weights.empty()) return true;
  const Lines lines(data, axis);
  const auto weight = [&](int row, int line) { return data.weights[lines.at(row, line)]; };
  for (int row = 1; row < lines.rows(); ++row)
    for (int line = 1; line < lines.lines(); ++line) {
      const double expected = weight(row, 0) / weight(0, 0) * weight(0, line);
      if (!(std::abs(weight(row, line) - expected) <= 1e-12 * expected)) return false;
    }
  return true;
}

bool straighten(SurfaceData& piece, int axis) {
  const Lines lines(piece, axis);
  const int degree = lines.rows() - 1;
  if (degree < 2 || degree != piece.degree[static_cast<std::size_t>(axis)]) return false;
  if (!lines.coincideOnAll(0, degree - 1, kSame) && !lines.coincideOnAll(1, degree, kSame)) return false;
  if (!weightsAreAlike(piece, axis) && !consistsOfFlatQuads(piece, axis, lines)) return false;
  evenOut(piece, lines);
  return true;
}

bool isFlatQuad(const SurfaceData& piece) {
  const int rows = piece.count(0), columns = piece.count(1);
  const Lines lines(piece, 0);
  const Corners corner = cornersOf(lines);
  if (!isFlatAndConvex(corner)) return false;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      if (!isWithin(corner, lines.point(row, column), {column == 0, row == rows - 1, column == columns - 1, row == 0}))
        return false;
  return true;
}

void makeBilinear(SurfaceData& piece) {
  const Corners corner = cornersOf(Lines(piece, 0));
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto [lo, hi] = piece.domain(static_cast<int>(axis));
    piece.knots[axis] = {lo, lo, hi, hi};
  }
  piece.degree = {1, 1};
  piece.points = {corner[0], corner[3], corner[1], corner[2]};
  piece.weights.clear();
}

bool isOnlyALine(const SurfaceData& piece, int axis) {
  const Lines lines(piece, axis);
  for (int line = 0; line < lines.lines(); ++line)
    for (int row = 1; row < lines.rows(); ++row)
      if (lines.point(row, line) != lines.point(0, line)) return false;
  return true;
}

}  // namespace hapticd::spline
