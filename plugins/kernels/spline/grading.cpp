// SPDX-License-Identifier: MIT
#include "kernels/spline/grading.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "kernels/spline/bernstein.hpp"
#include "kernels/spline/cusp.hpp"
#include "kernels/spline/line_set.hpp"
#include "kernels/spline/surface.hpp"

namespace hapticd::spline {
namespace {

using Eigen::Vector3d;

constexpr double kUneven = 1.4;   ///< largest ratio of speeds within one part
constexpr double kThin = 1e-8;    ///< share of the piece: a part that is narrower is made straight
constexpr double kFitted = 1e-9;  ///< share of the piece: largest error of a fit

/// The speed of a piece across its rows, as a function of the parameter along the axis.
class Speed {
 public:
  Speed(const SurfaceData& piece, int axis) : surface_(piece, Form::kNet), axis_(axis) {
    const auto breaks = surface_.breaks(1 - axis);
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
      for (int k = 0; k < kSamples; ++k) across_.push_back(std::lerp(breaks[i], breaks[i + 1], (k + 0.5) / kSamples));
  }

  /// Returns the largest speed [m per unit of the parameter] at t. What moves along the rows does not count.
  double at(double t) const {
    double most = 0;
    SurfacePoint E;
    for (const double s : across_) {
      surface_.evaluate1(axis_ == 0 ? t : s, axis_ == 0 ? s : t, E);
      const Vector3d &moving = axis_ == 0 ? E.Su : E.Sv, along = (axis_ == 0 ? E.Sv : E.Su).stableNormalized();
      most = std::max(most, (moving - along * along.dot(moving)).norm());
    }
    return most;
  }

 private:
  static constexpr int kSamples = 4;  // in each span across
  Surface surface_;
  int axis_;
  std::vector<double> across_;
};

/// A part of the piece, from `lo` to `hi` of the old parameter, with the speed at both ends and in the middle.
struct Part {
  double lo, hi;
  double speed_lo, speed_middle, speed_hi;
  bool thin;

  /// Length of the new parameter [m]. Unless the part is thin, the speed is then 1 at both ends.
  double width() const {
    const double share =
        thin ? (speed_lo + 4 * speed_middle + speed_hi) / 6 : 2 * speed_lo * speed_hi / (speed_lo + speed_hi);
    return share * (hi - lo);
  }
};

/// Divides a piece into parts of even speed, and thin parts at its ends.
class Division {
 public:
  Division(const SurfaceData& piece, int axis) : speed_(piece, axis), domain_(piece.domain(axis)) {
    const auto [lo, hi] = domain_;
    const Part whole = partOf(lo, speed_.at(lo), hi, speed_.at(hi));
    thin_ = kThin * (hi - lo) * std::max({whole.speed_lo, whole.speed_middle, whole.speed_hi});
    halve(whole, 0);
  }
  const std::vector<Part>& parts() const { return parts_; }
  /// False if the speed is so uneven that there would be too many parts.
  bool complete() const { return complete_; }
  double size() const { return thin_ / kThin; }  ///< [m] of the piece, about

 private:
  Part partOf(double lo, double speed_lo, double hi, double speed_hi) const {
    return {lo, hi, speed_lo, speed_.at(0.5 * (lo + hi)), speed_hi, false};
  }

  void halve(Part part, int halvings) {
    const double middle = 0.5 * (part.lo + part.hi), there = part.speed_middle;
    const auto [least, most] = std::minmax({part.speed_lo, there, part.speed_hi});
    const bool sound = std::isfinite(most) && static_cast<int>(parts_.size()) < kMostParts && halvings < kMostHalvings;
    complete_ = complete_ && sound;
    const bool even = most <= kUneven * least, at_end = part.lo == domain_[0] || part.hi == domain_[1];
    part.thin = !even && at_end && most * (part.hi - part.lo) <= thin_;
    if (part.thin || even || !sound) return parts_.push_back(part);
    halve(partOf(part.lo, part.speed_lo, middle, there), halvings + 1);
    halve(partOf(middle, there, part.hi, part.speed_hi), halvings + 1);
  }

  static constexpr int kMostHalvings = 40, kMostParts = 500;
  Speed speed_;
  std::array<double, 2> domain_;
  double thin_;  ///< [m]
  std::vector<Part> parts_;
  bool complete_ = true;
};

/// The graded piece, which grows part by part.
class Graded {
 public:
  Graded(const SurfaceData& piece, int axis, bool ruled)
      : piece_(piece),
        axis_(axis),
        ruled_(ruled),
        degree_(ruled ? kFitDegree : 2 * piece.degree[static_cast<std::size_t>(axis)]),
        lines_(piece, axis),
        rows_(static_cast<std::size_t>(piece.count(1 - axis))) {}

  void append(const Part& part) {
    const SurfaceData cut = lines_.part(part.lo, part.hi).surface(piece_, axis_);
    const double bend = part.thin ? 0.5 : part.speed_hi / (part.speed_lo + part.speed_hi);
    for (std::size_t line = 0; line < rows_.size(); ++line) {
      BezierCurve curve;
      for (int row = 0; row < cut.count(axis_); ++row) curve.push_back(at(cut, row, static_cast<int>(line)));
      const BezierCurve next = ruled_ ? fitted(curve, bend, degree_, error_) : composed(curve, bend);
      rows_[line].insert(rows_[line].end(), next.begin() + (rows_[line].empty() ? 0 : 1), next.end());
    }
    widths_.push_back(part.width());
  }

  /// Makes the first or the last part straight.
  void straightenFirst() {
    for (BezierCurve& row : rows_) straightenBeginning(row, static_cast<std::size_t>(degree_));
  }
  void straightenLast() {
    for (BezierCurve& row : rows_) {
      std::reverse(row.begin(), row.end());
      straightenBeginning(row, static_cast<std::size_t>(degree_));
      std::reverse(row.begin(), row.end());
    }
  }

  /// Gives the rows weights that change evenly from those of the first row to those of the last row. So the parameters
  /// along both rows stay as they are, and the next pieces share them.
  void restoreWeights() {
    double first = 0, last = 0;
    for (int line = 0; line < lineCount(); ++line) {
      first += at(piece_, 0, line).weight;
      last += at(piece_, piece_.count(axis_) - 1, line).weight;
    }
    for (int line = 0; line < lineCount(); ++line)
      multiply(rows_[static_cast<std::size_t>(line)], at(piece_, 0, line).weight,
               at(piece_, piece_.count(axis_) - 1, line).weight * (first / last));
    ++degree_;
  }

  double error() const { return error_; }  ///< [m]

  SurfaceData surface() const {
    SurfaceData result = piece_;
    const auto axis = static_cast<std::size_t>(axis_);
    result.degree[axis] = degree_;
    result.knots[axis] = knots(degree_);
    const std::size_t rows = rows_.front().size(), lines = rows_.size();
    result.points.resize(rows * lines);
    result.weights.resize(piece_.weights.empty() ? 0 : rows * lines);
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t line = 0; line < lines; ++line) {
        const std::size_t index = axis_ == 0 ? row * lines + line : line * rows + row;
        result.points[index] = rows_[line][row].point;
        if (!result.weights.empty()) result.weights[index] = rows_[line][row].weight;
      }
    return result;
  }

 private:
  static constexpr int kFitDegree = 9;
  int lineCount() const { return static_cast<int>(rows_.size()); }
  /// Multiplies a row, which consists of all parts, by a weight that changes evenly.
  void multiply(BezierCurve& row, double from, double to) const {
    const double whole = std::accumulate(widths_.begin(), widths_.end(), 0.0);
    double gone = 0;
    BezierCurve result;
    for (std::size_t part = 0; part < widths_.size(); ++part) {
      const auto begin = row.begin() + static_cast<std::ptrdiff_t>(part) * degree_;
      const double low = std::lerp(from, to, gone / whole), high = std::lerp(from, to, (gone + widths_[part]) / whole);
      const BezierCurve next = multiplied({begin, begin + degree_ + 1}, low, high);
      result.insert(result.end(), next.begin() + (part == 0 ? 0 : 1), next.end());
      gone += widths_[part];
    }
    row = std::move(result);
  }
  Weighted at(const SurfaceData& data, int row, int line) const {
    const auto index = static_cast<std::size_t>(axis_ == 0 ? row * data.count(1) + line : line * data.count(1) + row);
    return {data.points[index], data.weights.empty() ? 1 : data.weights[index]};
  }
  /// Returns the knots, each as often as the degree, over the domain of the piece.
  std::vector<double> knots(int degree) const {
    const auto [lo, hi] = piece_.domain(axis_);
    const double whole = std::accumulate(widths_.begin(), widths_.end(), 0.0);
    double gone = 0;
    std::vector<double> result(static_cast<std::size_t>(degree) + 1, lo);
    for (std::size_t i = 0; i + 1 < widths_.size(); ++i) {
      gone += widths_[i];
      result.insert(result.end(), static_cast<std::size_t>(degree), std::lerp(lo, hi, gone / whole));
    }
    result.insert(result.end(), static_cast<std::size_t>(degree) + 1, hi);
    return result;
  }

  const SurfaceData& piece_;
  int axis_;
  bool ruled_;
  int degree_;
  LineSet lines_;
  std::vector<BezierCurve> rows_;  ///< of each line
  std::vector<double> widths_;     ///< [m] of the parts
  double error_ = 0;
};

}  // namespace

bool grade(SurfaceData& piece, int axis) {
  const auto along = static_cast<std::size_t>(axis);
  if (piece.degree[along] < 2 || piece.count(axis) != piece.degree[along] + 1) return true;
  const Division division(piece, axis);
  const std::vector<Part>& parts = division.parts();
  if (!division.complete()) return false;
  if (parts.size() == 1) return true;
  for (const bool ruled : {true, false}) {
    if (ruled && (piece.degree[1 - along] != 1 || weightsAreAlike(piece, axis))) continue;
    if (!ruled && 2 * piece.degree[along] > kMaxDegree) return false;
    Graded graded(piece, axis, ruled);
    for (const Part& part : parts) graded.append(part);
    if (graded.error() > kFitted * division.size()) continue;
    if (ruled) graded.restoreWeights();
    if (parts.front().thin) graded.straightenFirst();
    if (parts.back().thin) graded.straightenLast();
    SurfaceData result = graded.surface();
    piece = std::move(result);
    return true;
  }
  return false;
}

}  // namespace hapticd::spline
