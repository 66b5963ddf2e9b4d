// SPDX-License-Identifier: MIT
#include "kernels/spline/bernstein.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hapticd::spline {
namespace {

using Eigen::Vector3d;

double binomial(int n, int k) {
  double result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// Returns (1 - x) a + x b, where x(y) has the Bernstein coefficients 0, bend, 1.
BezierCurve blend(const BezierCurve& a, const BezierCurve& b, double bend) {
  const int degree = static_cast<int>(a.size()) - 1;
  const double x[3] = {0, bend, 1};
  BezierCurve result(a.size() + 2);
  for (int k = 0; k <= degree + 2; ++k)
    for (int j = std::max(0, k - degree); j <= std::min(2, k); ++j) {
      const double share = binomial(degree, k - j) * binomial(2, j) / binomial(degree + 2, k);
      const auto i = static_cast<std::size_t>(k - j);
      result[static_cast<std::size_t>(k)].add(a[i], share * (1 - x[j]));
      result[static_cast<std::size_t>(k)].add(b[i], share * x[j]);
    }
  return result;
}

/// Returns the point of the curve at x, by de Casteljau's algorithm.
Vector3d pointAt(BezierCurve curve, double x) {
  for (; curve.size() > 1; curve.pop_back())
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      Weighted mean;
      mean.add(curve[i], 1 - x);
      mean.add(curve[i + 1], x);
      curve[i] = mean;
    }
  return curve.front().point;
}

/// Returns x(y), see composed().
double quadratic(double bend, double y) {
  return 2 * bend * y * (1 - y) + y * y;
}

double bernstein(int degree, int k, double y) {
  return binomial(degree, k) * std::pow(y, k) * std::pow(1 - y, degree - k);
}

}  // namespace

void Weighted::add(const Weighted& other, double share) {
  if (!(share * other.weight > 0)) return;
  weight += share * other.weight;
  point += (other.point - point) * (share * other.weight / weight);
}

BezierCurve composed(const BezierCurve& curve, double bend) {
  std::vector<BezierCurve> level;
  for (const Weighted& point : curve) level.push_back({point});
  for (; level.size() > 1; level.pop_back())
    for (std::size_t i = 0; i + 1 < level.size(); ++i) level[i] = blend(level[i], level[i + 1], bend);
  return level.front();
}

BezierCurve fitted(const BezierCurve& curve, double bend, int degree, double& error) {
  const auto node = [degree](double k) { return 0.5 - 0.5 * std::cos(std::numbers::pi * k / degree); };
  Eigen::MatrixXd basis(degree + 1, degree + 1), points(degree + 1, 3);
  for (int k = 0; k <= degree; ++k) {
    for (int i = 0; i <= degree; ++i) basis(k, i) = bernstein(degree, i, node(k));
    points.row(k) = pointAt(curve, quadratic(bend, node(k))) - curve.front().point;
  }
  const Eigen::MatrixXd solved = basis.partialPivLu().solve(points);
  BezierCurve result(static_cast<std::size_t>(degree) + 1, {curve.front().point, 1});
  for (int i = 1; i < degree; ++i) result[static_cast<std::size_t>(i)].point += solved.row(i).transpose();
  result.back().point = curve.back().point;
  for (int k = 0; k < degree; ++k) {
    const double y = node(k + 0.5);
    error = std::max(error, (pointAt(result, y) - pointAt(curve, quadratic(bend, y))).norm());
  }
  return result;
}

BezierCurve multiplied(const BezierCurve& curve, double from, double to) {
  const std::size_t degree = curve.size();  // of the result
  BezierCurve result(degree + 1);
  for (std::size_t k = 0; k <= degree; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(degree);
    if (k < degree) result[k].add({curve[k].point, from * curve[k].weight}, 1 - share);
    if (k > 0) result[k].add({curve[k - 1].point, to * curve[k - 1].weight}, share);
  }
  return result;
}

void straightenBeginning(BezierCurve& curve, std::size_t end) {
  constexpr double kOnLine = 1e-3;  // share of the length
  const Vector3d way = curve[end].point - curve[end + 1].point, old = curve.front().point - curve[end].point;
  const Vector3d straight = way.stableNormalized() * old.norm();
  Weighted begin = curve.front();
  if (!((straight - old).norm() <= kOnLine * old.norm()) && !way.isZero()) begin.point = curve[end].point + straight;
  const Weighted to = curve[end];
  for (std::size_t i = 0; i < end; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(end);
    curve[i] = {};
    curve[i].add(begin, 1 - share);
    curve[i].add(to, share);
  }
}

}  // namespace hapticd::spline
