// SPDX-License-Identifier: MIT
#include "kernels/spline/surface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "exact.hpp"
#include "samples.hpp"

namespace hapticd::spline {
namespace {

std::array<Eigen::Vector3d, 6> all(const SurfacePoint& E) {
  return {E.S, E.Su, E.Sv, E.Suu, E.Suv, E.Svv};
}

/// Worst error of all six vectors, each relative to the largest derivative of its order.
double worstError(const Surface& surface, const std::array<Eigen::Vector3d, 6>& truth, double u, double v) {
  SurfacePoint E;
  surface.evaluate2(u, v, E);
  const auto found = all(E);
  const std::array<double, 6> size = {0.2,
                                      std::max(truth[1].norm(), truth[2].norm()),
                                      std::max(truth[1].norm(), truth[2].norm()),
                                      std::max({truth[3].norm(), truth[4].norm(), truth[5].norm()}),
                                      std::max({truth[3].norm(), truth[4].norm(), truth[5].norm()}),
                                      std::max({truth[3].norm(), truth[4].norm(), truth[5].norm()})};
  double worst = 0;
  for (std::size_t k = 0; k < 6; ++k) worst = std::max(worst, (found[k] - truth[k]).norm() / std::max(size[k], 1e-3));
  return worst;
}

struct Variant {
  Form form;
  Instructions instructions;
};
constexpr Variant kVariants[] = {{Form::kTable, Instructions::kFastest},
                                 {Form::kTable, Instructions::kPortable},
                                 {Form::kNet, Instructions::kFastest},
                                 {Form::kNet, Instructions::kPortable}};

TEST(Surface, AgreesWithExactArithmeticInEveryFormForEveryDegreeToFive) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int p = 1; p <= 5; ++p) {
    for (int q = 1; q <= 5; ++q) {
      for (double spread : {0.0, 2.0}) {
        const SurfaceData data = samples::sheet({p, q}, {p + 3, q + 4}, spread, static_cast<unsigned>(10 * p + q));
        const double u = unit(random), v = unit(random);
        const auto inside = exact::surface(data, u, v), corner = exact::surface(data, 0, 1);
        for (const Variant& variant : kVariants) {
          const Surface surface(data, variant.form, variant.instructions);
          EXPECT_LT(worstError(surface, inside, u, v), 1e-11) << p << ' ' << q << ' ' << spread;
          EXPECT_LT(worstError(surface, corner, 0, 1), 1e-11) << p << ' ' << q << ' ' << spread;
        }
      }
    }
  }
}

TEST(Surface, AgreesWithExactArithmeticUpToDegreeFifteen) {
  for (const auto& degree : {std::array{7, 2}, std::array{9, 6}, std::array{15, 1}, std::array{2, 15}}) {
    for (double spread : {0.0, 3.0}) {
      const SurfaceData data = samples::sheet(degree, {degree[0] + 2, degree[1] + 2}, spread, 5);
      const auto truth = exact::surface(data, 0.37, 0.61);
      for (const Variant& variant : kVariants) {
        const Surface surface(data, variant.form, variant.instructions);
        EXPECT_LT(worstError(surface, truth, 0.37, 0.61), 1e-10);
      }
    }
  }
}

TEST(Surface, HasTheMixedDerivativeOfAPatchWhoseWeightHasOne) {
  SurfaceData data;
  data.degree = {1, 1};
  data.knots = {std::vector<double>{0, 0, 1, 1}, std::vector<double>{0, 0, 1, 1}};
  data.points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}};
  data.weights = {1, 2, 3, 7};  // w_uv = 1 - 2 - 3 + 7 = 3
  for (const Variant& variant : kVariants) {
    SurfacePoint E;
    Surface(data, variant.form, variant.instructions).evaluate2(0.25, 0.75, E);
    EXPECT_LT((E.Suv - exact::surface(data, 0.25, 0.75)[4]).norm(), 1e-14);
  }
}

TEST(Surface, HasDerivativesThatFiniteDifferencesConfirm) {
  constexpr double kStep = 1e-5;
  const SurfaceData data = samples::sheet({3, 4}, {6, 7}, 2, 77);
  const Surface surface(data);
  SurfacePoint E, left, right, low, high;
  const double u = 0.4321, v = 0.5678;
  surface.evaluate2(u, v, E);
  surface.evaluate2(u - kStep, v, left);
  surface.evaluate2(u + kStep, v, right);
  surface.evaluate2(u, v - kStep, low);
  surface.evaluate2(u, v + kStep, high);
  const double tolerance = 1e-6;
  EXPECT_LT(((right.S - left.S) / (2 * kStep) - E.Su).norm(), tolerance);
  EXPECT_LT(((high.S - low.S) / (2 * kStep) - E.Sv).norm(), tolerance);
  EXPECT_LT(((right.Su - left.Su) / (2 * kStep) - E.Suu).norm(), tolerance);
  EXPECT_LT(((right.Sv - left.Sv) / (2 * kStep) - E.Suv).norm(), tolerance);
  EXPECT_LT(((high.Su - low.Su) / (2 * kStep) - E.Suv).norm(), tolerance);
  EXPECT_LT(((high.Sv - low.Sv) / (2 * kStep) - E.Svv).norm(), tolerance);
}

TEST(Surface, FirstOrderEvaluationGivesTheSameTangents) {
  const Surface surface(samples::sphere(0.05));
  SurfacePoint one, two;
  surface.evaluate1(0.3, 0.7, one);
  surface.evaluate2(0.3, 0.7, two);
  EXPECT_LT((one.S - two.S).norm(), 1e-16);
  EXPECT_LT((one.Su - two.Su).norm(), 1e-15);
  EXPECT_LT((one.Sv - two.Sv).norm(), 1e-15);
}

TEST(Surface, IsAPointWhenAllControlPointsAre) {
  SurfaceData data = samples::sheet({3, 3}, {7, 7}, 2, 3);
  for (auto& point : data.points) point = Eigen::Vector3d(0.1, -0.2, 0.3);
  for (const Variant& variant : kVariants) {
    SurfacePoint E;
    Surface(data, variant.form, variant.instructions).evaluate2(0.3, 0.8, E);
    EXPECT_EQ(E.S, Eigen::Vector3d(0.1, -0.2, 0.3)) << "the basis functions add up to one";
    EXPECT_TRUE(E.Su.isZero(0) && E.Sv.isZero(0) && E.Suu.isZero(0) && E.Suv.isZero(0) && E.Svv.isZero(0));
  }
}

TEST(Surface, StartsAndEndsAtItsCornerPointsExactly) {
  const SurfaceData data = samples::sheet({3, 2}, {7, 6}, 2, 4);
  const Surface surface(data, Form::kNet);
  SurfacePoint E;
  surface.evaluate1(0, 0, E);
  EXPECT_EQ(E.S, data.points.front());
  surface.evaluate1(1, 1, E);
  EXPECT_EQ(E.S, data.points.back());
}

TEST(Surface, MovesParametersOutsideTheDomainToItsBoundary) {
  const SurfaceData data = samples::sheet({3, 3}, {7, 6}, 0, 9);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const Variant& variant : kVariants) {
    const Surface surface(data, variant.form, variant.instructions);
    SurfacePoint inside, outside;
    surface.evaluate2(0, 1, inside);
    for (double beyond : {1e-9, 1.0, 1e300, kInfinity}) {
      surface.evaluate2(-beyond, 1 + beyond, outside);
      EXPECT_EQ(inside.S, outside.S);
      EXPECT_EQ(inside.Suv, outside.Suv);
    }
    surface.evaluate2(std::nan(""), 1, outside);
    EXPECT_EQ(inside.S, outside.S) << "not-a-number goes to the low end";
  }
}

TEST(Surface, GivesTheSameBitsWhateverTheHint) {
  const Surface surface(samples::sheet({3, 3}, {12, 12}, 0, 8));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const double u =
        i % 10 == 0 ? surface.breaks(0)[static_cast<std::size_t>(i / 10) % surface.breaks(0).size()] : unit(random);
    const double v = unit(random);
    SurfacePoint fresh, hinted;
    hinted.span = {static_cast<std::int32_t>(random()), static_cast<std::int32_t>(random() % 12) - 1};
    surface.evaluate2(u, v, fresh);
    surface.evaluate2(u, v, hinted);
    ASSERT_EQ(fresh.S, hinted.S);
    ASSERT_EQ(fresh.Suv, hinted.Suv);
    ASSERT_EQ(fresh.span, hinted.span);
  }
}

TEST(Surface, TakesTheSpanToTheRightAtAKnotAndTheLastSpanAtTheEnd) {
  const Surface surface(samples::roof(0.8));
  SurfacePoint E;
  surface.evaluate1(0.5, 0.5, E);
  EXPECT_LT(E.Su.z(), 0) << "the right slope falls";
  surface.evaluate1(std::nextafter(0.5, 0), 0.5, E);
  EXPECT_GT(E.Su.z(), 0);
  surface.evaluate1(1, 0.5, E);
  EXPECT_LT(E.Su.z(), 0);
}

TEST(Surface, IsRoundToTheLastBitsOnTheSphereAndTheTorus) {
  const Surface sphere(samples::sphere(0.05)), torus(samples::torus(0.06, 0.02));
  EXPECT_EQ(sphere.form(), Form::kTable);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  SurfacePoint E;
  for (int i = 0; i < 2000; ++i) {
    const double u = unit(random), v = unit(random);
    sphere.evaluate1(u, v, E);
    EXPECT_NEAR(E.S.norm(), 0.05, 1e-16);
    torus.evaluate1(u, v, E);
    EXPECT_NEAR(std::hypot(std::hypot(E.S.x(), E.S.y()) - 0.06, E.S.z()), 0.02, 1e-16);
  }
}

TEST(Surface, KeepsTangentsNextToAPoleToFullRelativePrecision) {
  const SurfaceData data = samples::sphere(0.05);
  for (const Variant& variant : kVariants) {
    const Surface surface(data, variant.form, variant.instructions);
    for (double v : {1e-3, 1e-7, 1e-12, 1 - 1e-3, 1 - 1e-7, 1 - 1e-12}) {
      SurfacePoint E;
      surface.evaluate2(0.3, v, E);
      const auto truth = exact::surface(data, 0.3, v);
      EXPECT_LT((E.Su - truth[1]).norm(), 1e-13 * truth[1].norm()) << v;
      EXPECT_LT(E.Su.normalized().cross(E.Sv.normalized()).cross(E.S.normalized()).norm(), 1e-13) << v;
    }
    SurfacePoint pole;
    surface.evaluate1(0.3, 0, pole);
    EXPECT_TRUE(pole.Su.isZero(0)) << "the whole side is one point";
  }
}

TEST(Surface, TreatsEqualWeightsAsPolynomial) {
  SurfaceData data = samples::sheet({3, 3}, {6, 6}, 0, 2);
  data.weights.assign(data.points.size(), 0.25);
  const Surface surface(data);
  EXPECT_FALSE(surface.rational());
  EXPECT_LT(worstError(surface, exact::surface(data, 0.2, 0.9), 0.2, 0.9), 1e-12);
}

TEST(Surface, NeedsLessMemoryAsANet) {
  const SurfaceData data = samples::sheet({3, 3}, {10, 10}, 0, 2);
  EXPECT_LT(2 * Surface(data, Form::kNet).bytes(), Surface(data, Form::kTable).bytes());
}

}  // namespace
}  // namespace hapticd::spline
