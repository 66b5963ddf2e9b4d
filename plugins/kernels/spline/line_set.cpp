// SPDX-License-Identifier: MIT
#include "kernels/spline/line_set.hpp"

#include <algorithm>

namespace hapticd::spline {
namespace {

Eigen::Vector3d mean(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) {
  return {std::lerp(a.x(), b.x(), share), std::lerp(a.y(), b.y(), share), std::lerp(a.z(), b.z(), share)};
}

template <class T>
std::vector<T> transposed(const std::vector<T>& grid, std::size_t rows) {
  const std::size_t columns = rows == 0 ? 0 : grid.size() / rows;
  std::vector<T> result(grid.size());
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) result[j * rows + i] = grid[i * columns + j];
  }
  return result;
}

}  // namespace

LineSet::LineSet(const CurveData& curve)
    : degree_(curve.degree), knots_(curve.knots), points_(curve.points), weights_(curve.weights) {}

LineSet::LineSet(const SurfaceData& surface, int axis)
    : degree_(surface.degree[static_cast<std::size_t>(axis)]),
      lines_(static_cast<std::size_t>(surface.count(1 - axis))),
      knots_(surface.knots[static_cast<std::size_t>(axis)]) {
  const auto rows = static_cast<std::size_t>(surface.count(0));
  points_ = axis == 0 ? surface.points : transposed(surface.points, rows);
  if (!surface.weights.empty()) weights_ = axis == 0 ? surface.weights : transposed(surface.weights, rows);
}

void LineSet::insert(double t) {
  const auto p = static_cast<std::size_t>(degree_);
  const auto k = static_cast<std::size_t>(std::upper_bound(knots_.begin(), knots_.end(), t) - knots_.begin()) - 1;
  const auto s = static_cast<std::size_t>(multiplicity(t));
  if (s >= p) return;
  // points before `first` and behind `last` are copied as a block: a surface of 300 x 300 spans has 2e5 insertions
  const std::size_t first = k + 1 > p ? k + 1 - p : 0, last = k - s;
  const auto block = [this](std::size_t point) { return static_cast<std::ptrdiff_t>(point * lines_); };
  std::vector<Eigen::Vector3d> points(points_.begin(), points_.begin() + block(first));
  std::vector<double> weights(weights_.begin(), weights_.empty() ? weights_.end() : weights_.begin() + block(first));
  points.reserve(points_.size() + lines_);
  for (std::size_t i = first; i <= last; ++i) {
    for (std::size_t l = 0; l < lines_; ++l) {
      const std::size_t after = std::min(i, count() - 1) * lines_ + l;
      const std::size_t before = (i == 0 ? 0 : i - 1) * lines_ + l;
      double share = (t - knots_[i]) / (knots_[i + p] - knots_[i]);
      if (!weights_.empty()) {
        weights.push_back(std::lerp(weights_[before], weights_[after], share));
        share *= weights_[after] / weights.back();
      }
      points.push_back(mean(points_[before], points_[after], share));
    }
  }
  points.insert(points.end(), points_.begin() + block(last), points_.end());
  if (!weights_.empty()) weights.insert(weights.end(), weights_.begin() + block(last), weights_.end());
  points_ = std::move(points);
  weights_ = std::move(weights);
  knots_.insert(knots_.begin() + static_cast<std::ptrdiff_t>(k) + 1, t);
}

void LineSet::raise(double t, int wanted) {
  for (int s = multiplicity(t); s < std::min(wanted, degree_); ++s) insert(t);
}

LineSet LineSet::part(double lo, double hi) const {
  LineSet raised;
  if (multiplicity(lo) < degree_ || multiplicity(hi) < degree_) {
    raised = *this;
    raised.raise(lo, degree_);
    raised.raise(hi, degree_);
  }
  const LineSet& whole = raised.knots_.empty() ? *this : raised;
  const auto begin = whole.knots_.begin();
  const auto p = static_cast<std::size_t>(degree_);
  const auto low = static_cast<std::size_t>(std::upper_bound(begin, whole.knots_.end(), lo) - begin) - 1;
  const auto high = static_cast<std::size_t>(std::lower_bound(begin, whole.knots_.end(), hi) - begin);
  LineSet result;
  result.degree_ = degree_;
  result.lines_ = lines_;
  result.knots_.assign(p + 1, lo);
  result.knots_.insert(result.knots_.end(), begin + static_cast<std::ptrdiff_t>(low) + 1,
                       begin + static_cast<std::ptrdiff_t>(high));
  result.knots_.insert(result.knots_.end(), p + 1, hi);
  const auto first = static_cast<std::ptrdiff_t>((low - p) * lines_), last = static_cast<std::ptrdiff_t>(high * lines_);
  result.points_.assign(whole.points_.begin() + first, whole.points_.begin() + last);
  if (!weights_.empty()) result.weights_.assign(whole.weights_.begin() + first, whole.weights_.begin() + last);
  return result;
}

std::array<double, 2> LineSet::domain() const noexcept {
  return {knots_[static_cast<std::size_t>(degree_)], knots_[count()]};
}

int LineSet::multiplicity(double t) const noexcept {
  return static_cast<int>(std::count(knots_.begin(), knots_.end(), t));
}

std::vector<double> LineSet::breaks() const {
  std::vector<double> result(knots_.begin() + degree_, knots_.begin() + static_cast<std::ptrdiff_t>(count()) + 1);
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

CurveData LineSet::curve(std::string name) const {
  return {degree_, knots_, points_, weights_, std::move(name)};
}

SurfaceData LineSet::surface(const SurfaceData& like, int axis) const {
  SurfaceData result;
  result.degree = like.degree;
  result.knots = like.knots;
  result.knots[static_cast<std::size_t>(axis)] = knots_;
  result.points = axis == 0 ? points_ : transposed(points_, count());
  if (!weights_.empty()) result.weights = axis == 0 ? weights_ : transposed(weights_, count());
  result.reversed = like.reversed;
  result.name = like.name;
  return result;
}

}  // namespace hapticd::spline
