// SPDX-License-Identifier: MIT
#include "kernels/medial/skeleton.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kernels/spline/interpolation.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector3d;

void requireGrid(const SkeletonGrid& grid) {
  const std::string size = std::to_string(grid.count[0]) + " x " + std::to_string(grid.count[1]);
  if (grid.count[0] < 1 || grid.count[1] < 1 || grid.count[0] * grid.count[1] < 2)
    throw std::invalid_argument("skeleton: " + size + " points; the grid must have at least two");
  const auto total = static_cast<std::size_t>(grid.count[0]) * static_cast<std::size_t>(grid.count[1]);
  if (grid.points.size() != total || grid.radius.size() != total)
    throw std::invalid_argument("skeleton: " + std::to_string(grid.points.size()) + " points and " +
                                std::to_string(grid.radius.size()) + " radii, expected " + std::to_string(total));
}

Eigen::MatrixXd rowsOf(const std::vector<Vector3d>& points) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) rows.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  return rows;
}

/// Returns for each control point the mean of `degree` successive knots: the parameter at which it acts most.
std::vector<double> grevilleOf(const std::vector<double>& knots, int degree, int count) {
  std::vector<double> all(static_cast<std::size_t>(count), 0);
  for (int i = 0; i < count && degree > 0; ++i) {
    for (int k = 1; k <= degree; ++k) all[static_cast<std::size_t>(i)] += knots[static_cast<std::size_t>(i + k)];
    all[static_cast<std::size_t>(i)] /= degree;
  }
  return all;
}

}  // namespace

Skeleton::Skeleton(const SkeletonGrid& grid, int degree, spline::Form form) {
  requireGrid(grid);
  curve_ = grid.count[0] == 1 || grid.count[1] == 1;
  if (curve_) {
    buildCurve(grid, degree, form);
  } else {
    build(grid, degree, form);
  }
  for (std::size_t a = 0; a < 2; ++a)
    control_.greville[a] = grevilleOf(control_.knots[a], control_.degree[a], control_.count[a]);
  measure();
}

void Skeleton::build(const SkeletonGrid& grid, int degree, spline::Form form) {
  const spline::GridFit fit = spline::interpolateGrid(
      rowsOf(grid.points), grid.count, {std::min(degree, grid.count[0] - 1), std::min(degree, grid.count[1] - 1)});
  for (Eigen::Index i = 0; i < fit.control.rows(); ++i) control_.points.emplace_back(fit.control.row(i).transpose());
  control_.count = fit.count;
  control_.degree = fit.degree;
  control_.knots = fit.knots;
  surface_ = std::make_unique<spline::Surface>(
      spline::SurfaceData{fit.degree, fit.knots, control_.points, {}, false, "skeleton"}, form);
  parameters_ = fit.parameters;
  radius_ = ScalarField(parameters_, grid.radius);
  radius_.raise(grid.ball);
}

/// Stores a curve as the surface between two copies of the curve. Su is zero, so no search moves u.
void Skeleton::buildCurve(const SkeletonGrid& grid, int degree, spline::Form form) {
  const int count = static_cast<int>(grid.points.size());
  const spline::CurveFit fit = spline::interpolateCurve(rowsOf(grid.points), std::min(degree, count - 1));
  for (Eigen::Index i = 0; i < fit.control.rows(); ++i) control_.points.emplace_back(fit.control.row(i).transpose());
  control_.count = {1, count};
  control_.degree = {0, fit.degree};
  control_.knots = {std::vector<double>{0, 1}, fit.knots};
  std::vector<Vector3d> twice = control_.points;
  twice.insert(twice.end(), control_.points.begin(), control_.points.end());
  surface_ = std::make_unique<spline::Surface>(
      spline::SurfaceData{{1, fit.degree}, {{{0, 0, 1, 1}, fit.knots}}, twice, {}, false, "skeleton"}, form);
  parameters_ = {std::vector<double>{0, 1}, fit.parameters};
  std::vector<double> radius = grid.radius;
  radius.insert(radius.end(), grid.radius.begin(), grid.radius.end());
  radius_ = ScalarField(parameters_, radius);
  radius_.raise(grid.ball);
}

/// Computes the bounds. A spline stays in the box of its control points, and no radius is greater than the greatest
/// sample.
void Skeleton::measure() {
  for (const Vector3d& point : control_.points) bounds_.extend(point);
  const Vector3d reach = Vector3d::Constant(radius_.greatest());
  bounds_ = Eigen::AlignedBox3d(bounds_.min() - reach, bounds_.max() + reach);
  spline::SurfacePoint a, b;
  for (std::size_t axis = curve_ ? 1 : 0; axis < 2; ++axis) {
    const std::vector<double>&along = parameters_[axis], &over = parameters_[1 - axis];
    for (const double w : over) {
      for (std::size_t i = 0; i + 1 < along.size(); ++i) {
        axis == 0 ? surface_->evaluate1(along[i], w, a) : surface_->evaluate1(w, along[i], a);
        axis == 0 ? surface_->evaluate1(along[i + 1], w, b) : surface_->evaluate1(w, along[i + 1], b);
        spacing_ = std::max(spacing_, (b.S - a.S).norm());
      }
    }
  }
  nested_ = steepest().slope >= 1;
}

Steepness Skeleton::steepest() const {
  constexpr int kLooks = 4;  // samples per cell, along each direction
  // share of the squared trace; a smaller determinant is a pole, which has only one direction
  constexpr double kCollapsed = 1e-9;
  Steepness most;
  const auto look = [&](double u, double v) {
    spline::SurfacePoint s;
    surface_->evaluate1(u, v, s);
    const ScalarField::Value r = radius_.evaluate(u, v);
    const double a = s.Su.squaredNorm(), b = s.Su.dot(s.Sv), c = s.Sv.squaredNorm(), area2 = a * c - b * b;
    double square = 0;
    if (curve_) {
      if (c > 0) square = r.fv * r.fv / c;
    } else if (area2 > kCollapsed * (a + c) * (a + c)) {
      square = (c * r.fu * r.fu - 2 * b * r.fu * r.fv + a * r.fv * r.fv) / area2;
    }
    if (square > most.slope * most.slope) most = {std::sqrt(square), u, v};
  };
  const auto places = [](const std::vector<double>& t) {
    std::vector<double> all;
    for (std::size_t i = 0; i + 1 < t.size(); ++i)
      for (int k = 0; k < kLooks; ++k) all.push_back(t[i] + (t[i + 1] - t[i]) * k / kLooks);
    all.push_back(t.back());
    return all;
  };
  const std::vector<double> along = places(parameters_[1]);
  for (const double u : curve_ ? std::vector<double>{0} : places(parameters_[0]))
    for (const double v : along) look(u, v);
  return most;
}

std::size_t Skeleton::bytes() const noexcept {
  std::size_t sum = sizeof *this + surface_->bytes() + radius_.bytes() + control_.points.capacity() * sizeof(Vector3d);
  for (std::size_t a = 0; a < 2; ++a)
    sum +=
        (parameters_[a].capacity() + control_.knots[a].capacity() + control_.greville[a].capacity()) * sizeof(double);
  return sum;
}

}  // namespace hapticd::medial
