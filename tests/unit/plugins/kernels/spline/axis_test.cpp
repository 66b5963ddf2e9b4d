// SPDX-License-Identifier: MIT
#include "kernels/spline/axis.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "kernels/spline/basis.hpp"
#include "samples.hpp"

namespace hapticd::spline {
namespace {

TEST(Axis, FindsTheSpanOfEveryParameterFromAnyHint) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-0.1, 1.1);
  for (int degree = 1; degree <= 15; ++degree) {
    const Axis axis(degree, samples::knots(degree, degree + 20, random));
    for (int i = 0; i < 500; ++i) {
      auto hint = static_cast<std::int32_t>(random());
      const double wanted = unit(random), t = axis.locate(wanted, hint);
      ASSERT_EQ(t, std::clamp(wanted, 0.0, 1.0));
      ASSERT_LE(axis.cell(hint).lo, t);
      ASSERT_LT(t, axis.cell(hint).end);
    }
  }
}

TEST(Axis, AgreesWithTheSpanSearchOfTheSetUpCode) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto knots = samples::knots(3, 20, random);
  const Axis axis(3, knots);
  for (int i = 0; i < 500; ++i) {
    const double t = i < 20 ? knots[static_cast<std::size_t>(i)] : unit(random);
    std::int32_t hint = -1;
    EXPECT_EQ(axis.cell((axis.locate(t, hint), hint)).knot, findSpan(knots, 3, t));
  }
  EXPECT_EQ(findSpan(knots, 3, -5), findSpan(knots, 3, 0));
  EXPECT_EQ(findSpan(knots, 3, 5), findSpan(knots, 3, 1));
}

TEST(Axis, HalvesASingleSpanThatCollapsesAtBothEnds) {
  Axis axis(3, {0, 0, 0, 0, 1, 1, 1, 1});
  axis.anchor(true, true);
  ASSERT_EQ(axis.cells().size(), 2u);
  EXPECT_EQ(axis.cells()[0].origin, 0);
  EXPECT_EQ(axis.cells()[1].origin, 1);
  std::int32_t hint = 0;
  EXPECT_EQ(axis.locate(0.75, hint), 0.75);
  EXPECT_EQ(hint, 1);
  EXPECT_EQ(axis.breaks().size(), 2u) << "still one span";
}

TEST(BasisFunctions, AreNotNegativeAndAddUpToOne) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int degree = 1; degree <= 15; ++degree) {
    const auto knots = samples::knots(degree, degree + 9, random);
    for (int i = 0; i < 200; ++i) {
      const double t = unit(random);
      std::array<double, kMaxDegree + 1> N;
      basisFunctions(knots, degree, findSpan(knots, degree, t), t, N);
      const double sum = std::accumulate(N.begin(), N.begin() + degree + 1, 0.0);
      EXPECT_NEAR(sum, 1, 1e-14);
      EXPECT_GE(*std::min_element(N.begin(), N.begin() + degree + 1), 0);
    }
  }
}

}  // namespace
}  // namespace hapticd::spline
