// SPDX-License-Identifier: MIT
#include "kernels/spline/bernstein.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hapticd::spline {
namespace {

using Eigen::Vector3d;

/// Evaluates a curve at y by the definition of the Bernstein polynomials.
Vector3d at(const BezierCurve& curve, double y) {
  const auto degree = static_cast<double>(curve.size() - 1);
  Vector3d sum = Vector3d::Zero();
  double weights = 0;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    const auto i = static_cast<double>(k);
    const double basis = std::exp(std::lgamma(degree + 1) - std::lgamma(i + 1) - std::lgamma(degree - i + 1)) *
                         std::pow(y, i) * std::pow(1 - y, degree - i) * curve[k].weight;
    sum += basis * curve[k].point;
    weights += basis;
  }
  return sum / weights;
}

const BezierCurve kCurve = {{{0, 0, 0}, 1}, {{0, 1, 2}, 0.5}, {{3, 1, 0}, 2}, {{4, -1, 1}, 1}};
constexpr double kBend = 0.7;

double x(double y) {
  return 2 * kBend * y * (1 - y) + y * y;
}

TEST(BezierCurve, ComposedWithAQuadraticIsTheSameCurve) {
  const BezierCurve curve = composed(kCurve, kBend);
  ASSERT_EQ(curve.size(), 7u);
  for (double y = 0; y <= 1; y += 0.125) EXPECT_LT((at(curve, y) - at(kCurve, x(y))).norm(), 1e-13) << y;
}

TEST(BezierCurve, ComposedKeepsEqualPointsToTheBit) {
  const Vector3d same(0.1, 0.2, 0.3);
  for (const Weighted& one : composed({{same, 1}, {same, 3}, {same, 0.7}}, kBend)) EXPECT_EQ(one.point, same);
}

TEST(BezierCurve, AFitTellsItsError) {
  double error = 0;
  const BezierCurve curve = fitted(kCurve, kBend, 9, error);
  double worst = 0;
  for (double y = 0; y <= 1; y += 0.01) worst = std::max(worst, (at(curve, y) - at(kCurve, x(y))).norm());
  EXPECT_GT(error, 0);
  EXPECT_LT(worst, 1.5 * error);
  EXPECT_LT(error, 0.02);
}

TEST(BezierCurve, MultipliedByAWeightIsTheSameCurve) {
  const BezierCurve curve = multiplied(kCurve, 2, 5);
  ASSERT_EQ(curve.size(), 5u);
  EXPECT_EQ(curve.front().weight, 2);
  EXPECT_EQ(curve.back().weight, 5);
  for (double y = 0; y <= 1; y += 0.125) EXPECT_LT((at(curve, y) - at(kCurve, y)).norm(), 1e-13) << y;
}

}  // namespace
}  // namespace hapticd::spline
