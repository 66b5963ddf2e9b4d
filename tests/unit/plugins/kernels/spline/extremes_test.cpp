// SPDX-License-Identifier: MIT
// Numbers at the ends of what a double holds, and weights and knots at the ends of what a model file may.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "exact.hpp"
#include "kernels/spline/surface.hpp"
#include "samples.hpp"

namespace hapticd::spline {
namespace {

constexpr Form kForms[] = {Form::kTable, Form::kNet};

std::array<Eigen::Vector3d, 6> evaluate(const SurfaceData& data, Form form, double u, double v) {
  SurfacePoint E;
  Surface(data, form).evaluate2(u, v, E);
  return {E.S, E.Su, E.Sv, E.Suu, E.Suv, E.Svv};
}

void expectNear(const std::array<Eigen::Vector3d, 6>& found, const std::array<Eigen::Vector3d, 6>& truth,
                double relative, double absolute = 0) {
  for (std::size_t k = 0; k < 6; ++k) {
    const double size = truth[k].cwiseAbs().maxCoeff();
    EXPECT_LE((found[k] - truth[k]).cwiseAbs().maxCoeff(), relative * size + (k == 0 ? absolute : 0))
        << "vector " << k << ": " << found[k].transpose() << " for " << truth[k].transpose();
  }
}

TEST(Extremes, CoordinatesOfOneMegametreKeepMillimetreFeatures) {
  for (double offset : {1e6, 1e9, 1e12}) {
    SurfaceData data = samples::sheet({3, 3}, {6, 6}, 1.5, 21);
    for (auto& point : data.points) point = Eigen::Vector3d::Constant(offset) + 10 * point;
    for (Form form : kForms) {
      const auto truth = exact::surface(data, 0.3, 0.6);
      const auto found = evaluate(data, form, 0.3, 0.6);
      expectNear(found, truth, 1e-11, 1e-16 * offset);
    }
  }
}

TEST(Extremes, CoordinatesOfAnyMagnitudeScale) {
  for (double scale : {1e-310, 1e-300, 1e-200, 1e-100, 1e100, 1e200, 1e300, 1e307}) {
    SurfaceData data = samples::sheet({2, 3}, {4, 6}, 1.5, 22);
    for (auto& point : data.points) point *= scale;
    for (Form form : kForms) {
      const double subnormal = 4 * std::numeric_limits<double>::denorm_min();
      const auto truth = exact::surface(data, 0.3, 0.6);
      const auto found = evaluate(data, form, 0.3, 0.6);
      for (std::size_t k = 0; k < 6; ++k) {
        ASSERT_TRUE(found[k].allFinite() || !truth[k].allFinite()) << scale;
        if (!truth[k].allFinite()) continue;
        EXPECT_LE((found[k] - truth[k]).cwiseAbs().maxCoeff(), 1e-11 * truth[k].cwiseAbs().maxCoeff() + subnormal);
      }
    }
  }
}

TEST(Extremes, OppositeHugeCoordinatesDoNotOverflowBetweenEachOther) {
  SurfaceData data = samples::sheet({3, 3}, {4, 4}, 0, 23);
  for (std::size_t i = 0; i < data.points.size(); ++i) data.points[i].setConstant(i % 2 == 0 ? 1.7e308 : -1.7e308);
  for (Form form : kForms) EXPECT_TRUE(evaluate(data, form, 0.5, 0.5)[0].allFinite());
}

TEST(Extremes, WeightsOverEighteenOrdersKeepTheirDerivatives) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const SurfaceData data = samples::sheet({3, 3}, {6, 6}, 1e9, seed);
    for (double u : {0.0, 0.31, 1.0}) {
      const auto truth = exact::surface(data, u, 0.77);
      for (Form form : kForms) {
        const auto found = evaluate(data, form, u, 0.77);
        EXPECT_LT((found[0] - truth[0]).norm(), 1e-15);
        EXPECT_LT((found[1] - truth[1]).norm(), 1e-11 * truth[1].norm());
        EXPECT_LT((found[2] - truth[2]).norm(), 1e-11 * truth[2].norm());
      }
    }
  }
}

TEST(Extremes, HugeAndTinyCommonWeightsChangeNothing) {
  const SurfaceData data = samples::sheet({2, 2}, {5, 5}, 2, 24);
  for (double factor : {1e-290, 1e290}) {
    SurfaceData scaled = data;
    for (double& w : scaled.weights) w *= factor;
    for (Form form : kForms) expectNear(evaluate(scaled, form, 0.4, 0.6), evaluate(data, form, 0.4, 0.6), 1e-11, 1e-16);
  }
}

TEST(Extremes, KnotSpansOfOnePicometreAreEvaluatedInsideAndBeside) {
  for (double width : {1e-12, 1e-15}) {
    SurfaceData data = samples::sheet({3, 3}, {6, 6}, 0, 25);
    const double next = 0.5 + width;
    data.knots[0] = {0, 0, 0, 0, 0.5, next, 1, 1, 1, 1};
    for (Form form : kForms) {
      for (double u : {0.25, 0.5, 0.5 + width / 3, next, 0.75}) {
        expectNear(evaluate(data, form, u, 0.3), exact::surface(data, u, 0.3), 1e-9, 1e-16);
      }
    }
  }
}

TEST(Extremes, ParametersFarFromZeroKeepTheirSpans) {
  for (double offset : {1e6, -1e9}) {
    SurfaceData data = samples::sheet({3, 3}, {6, 6}, 0, 26);
    for (auto& knots : data.knots) {
      for (double& knot : knots) knot = offset + 64 * std::round(knot * 16);
    }
    for (Form form : kForms) {
      const double u = offset + 200.125, v = offset + 800.5;
      expectNear(evaluate(data, form, u, v), exact::surface(data, u, v), 1e-9, 1e-15);
    }
  }
}

TEST(Extremes, WideAndNarrowDomainsHaveFiniteDerivatives) {
  for (double width : {1e-90, 1e-30, 1e30, 1e90}) {
    for (int degree : {1, 3, 9}) {
      SurfaceData data = samples::sheet({degree, 2}, {degree + 2, 4}, 0, 27);
      for (double& knot : data.knots[0]) knot *= width;
      for (Form form : kForms) {
        const auto found = evaluate(data, form, 0.4 * width, 0.6);
        for (const auto& vector : found) EXPECT_TRUE(vector.allFinite()) << width << ' ' << degree;
        expectNear(found, exact::surface(data, 0.4 * width, 0.6), 1e-9, 1e-15);
      }
    }
  }
}

TEST(Extremes, KnotsThatAreNotClampedAreEvaluatedOnTheirDomain) {
  SurfaceData data = samples::sheet({3, 2}, {7, 6}, 1.5, 28);
  for (std::size_t i = 0; i < data.knots[0].size(); ++i) data.knots[0][i] = static_cast<double>(i);
  for (Form form : kForms) {
    const Surface surface(data, form);
    EXPECT_EQ(surface.domain(0), (std::array<double, 2>{3, 7}));
    for (double u : {3.0, 4.5, 7.0})
      expectNear(evaluate(data, form, u, 0.4), exact::surface(data, u, 0.4), 1e-10, 1e-15);
  }
}

TEST(Extremes, RandomParametersOfRandomSurfacesAreAlwaysFinite) {
  std::mt19937 random(29);
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::array<int, 2> degree{1 + static_cast<int>(random() % 15), 1 + static_cast<int>(random() % 15)};
    const double spread = std::pow(10.0, static_cast<double>(random() % 10));
    const SurfaceData data = samples::sheet(degree, {degree[0] + 1 + static_cast<int>(random() % 6), degree[1] + 3},
                                            random() % 2 == 0 ? 0 : spread, seed);
    for (Form form : kForms) {
      const Surface surface(data, form);
      for (int i = 0; i < 50; ++i) {
        SurfacePoint E;
        surface.evaluate2(static_cast<double>(random()) / 4e9, static_cast<double>(random()) / 4e9, E);
        ASSERT_TRUE(E.S.allFinite() && E.Su.allFinite() && E.Sv.allFinite());
        ASSERT_TRUE(E.Suu.allFinite() && E.Suv.allFinite() && E.Svv.allFinite());
        ASSERT_LT(E.S.cwiseAbs().maxCoeff(), 0.3) << "inside the hull of the control points";
      }
    }
  }
}

}  // namespace
}  // namespace hapticd::spline
