// SPDX-License-Identifier: MIT
#include "kernels/spline/refinement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernels/spline/curve.hpp"
#include "kernels/spline/surface.hpp"
#include "samples.hpp"

namespace hapticd::spline {
namespace {

/// Largest distance of two surfaces over a grid on a common part of their domains.
double gap(const SurfaceData& whole, const SurfaceData& part) {
  const Surface a(whole, Form::kNet), b(part, Form::kNet);
  const auto u = b.domain(0), v = b.domain(1);
  SurfacePoint E, F;
  double worst = 0;
  for (int i = 0; i <= 12; ++i) {
    for (int j = 0; j <= 12; ++j) {
      // Not quite to the ends: at a gap the whole continues on the right side.
      const double s = std::lerp(u[0], u[1], std::min(i / 12.0, 1 - 1e-12));
      const double t = std::lerp(v[0], v[1], std::min(j / 12.0, 1 - 1e-12));
      a.evaluate1(s, t, E);
      b.evaluate1(s, t, F);
      worst = std::max(worst, (E.S - F.S).norm());
    }
  }
  return worst;
}

TEST(Refinement, LeavesTheSurfaceAsItIs) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const int p = 1 + static_cast<int>(seed % 5), q = 1 + static_cast<int>(seed % 3);
    const SurfaceData data = samples::sheet({p, q}, {p + 4, q + 3}, seed % 2 == 0 ? 0 : 3, seed);
    const std::vector<double> added = {0.1, 0.45, 0.45, 0.9, 0.9, 0.9};
    const SurfaceData fine = refine(refine(data, 0, added), 1, added);
    validate(fine);
    EXPECT_LT(gap(data, fine), 1e-15);
  }
}

TEST(Refinement, AddsAsManyPointsAsKnotsAndRefusesKnotsOutside) {
  const SurfaceData data = samples::sheet({3, 3}, {6, 6}, 0, 1);
  EXPECT_EQ(refine(data, 0, std::vector<double>{0.111, 0.222}).points.size(), 8u * 6u);
  EXPECT_THROW(refine(data, 0, std::vector<double>{1.5}), std::invalid_argument);
  EXPECT_THROW(refine(data, 1, std::vector<double>{std::nan("")}), std::invalid_argument);
}

TEST(Refinement, BezierPiecesAreTheSurface) {
  for (double spread : {0.0, 3.0}) {
    const SurfaceData data = samples::sheet({3, 2}, {8, 6}, spread, 31);
    const Surface whole(data);
    const auto pieces = bezierPieces(data);
    ASSERT_EQ(pieces.size(), (whole.breaks(0).size() - 1) * (whole.breaks(1).size() - 1));
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      const SurfaceData& piece = pieces[k];
      EXPECT_EQ(piece.points.size(), 4u * 3u);
      EXPECT_EQ(piece.domain(0)[0], whole.breaks(0)[k / (whole.breaks(1).size() - 1)]) << "u-major";
      EXPECT_EQ(piece.domain(1)[0], whole.breaks(1)[k % (whole.breaks(1).size() - 1)]);
      EXPECT_LT(gap(data, piece), 1e-15);
    }
  }
}

TEST(Refinement, BezierPiecesOfCurvesAreTheCurve) {
  CurveData data;
  data.degree = 2;
  data.knots = {0, 1, 2, 3, 4, 5, 6};  // not clamped
  data.points = {{0, 0, 0}, {1, 2, 0}, {2, -1, 1}, {3, 0, 0}};
  const Curve whole(data);
  const auto pieces = bezierPieces(data);
  ASSERT_EQ(pieces.size(), 2u);
  for (const CurveData& piece : pieces) {
    const Curve part(piece);
    CurvePoint E, F;
    for (int i = 0; i <= 10; ++i) {
      const double t = std::lerp(part.domain()[0], part.domain()[1], i / 10.0);
      whole.evaluate1(t, E);
      part.evaluate1(t, F);
      EXPECT_LT((E.C - F.C).norm(), 1e-15);
    }
  }
  const std::vector<double> added = {2.5};
  EXPECT_EQ(refine(data, added).points.size(), 5u);
  EXPECT_EQ(cut(data, 2.5, 3.5).domain(), (std::array<double, 2>{2.5, 3.5}));
}

TEST(Refinement, KeepsCollapsedSidesCollapsedToTheLastBit) {
  for (const SurfaceData& piece : bezierPieces(samples::sphere(0.05))) {
    const bool south = piece.domain(1)[0] == 0;
    const Eigen::Vector3d pole(0, 0, south ? -0.05 : 0.05);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(piece.points[3 * i + (south ? 0 : 2)], pole);
  }
}

TEST(Refinement, CutKeepsTheParametersOfTheWhole) {
  const SurfaceData data = samples::sheet({3, 3}, {7, 7}, 2, 41);
  const SurfaceData part = cut(cut(data, 0, 0.2, 0.7), 1, 0.1, 1.0);
  EXPECT_EQ(part.domain(0), (std::array<double, 2>{0.2, 0.7}));
  EXPECT_LT(gap(data, part), 1e-15);
  EXPECT_THROW(cut(data, 0, 0.7, 0.7), std::invalid_argument);
  EXPECT_THROW(cut(data, 0, -0.1, 0.7), std::invalid_argument);
}

TEST(SplitAtCreases, PartsARoofAtItsRidge) {
  const SurfaceData data = samples::roof(0.8);
  const auto parts = splitAtCreases(data);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].domain(0), (std::array<double, 2>{0, 0.5}));
  EXPECT_EQ(parts[1].domain(0), (std::array<double, 2>{0.5, 1}));
  for (const SurfaceData& part : parts) EXPECT_LT(gap(data, part), 1e-15);
}

TEST(SplitAtCreases, LeavesARoofWithoutSlopeWhole) {
  EXPECT_EQ(splitAtCreases(samples::roof(0)).size(), 1u);
}

TEST(SplitAtCreases, LeavesCirclesSpheresAndToriWhole) {
  EXPECT_EQ(splitAtCreases(samples::sphere(0.05)).size(), 1u);
  EXPECT_EQ(splitAtCreases(samples::torus(0.06, 0.02)).size(), 1u);
}

TEST(SplitAtCreases, PartsAtAGap) {
  SurfaceData data = samples::roof(0);
  data.knots[0] = {0, 0, 0, 0, .5, .5, .5, .5, 1, 1, 1, 1};
  for (int j = 0; j < 4; ++j) data.points.emplace_back(2, j / 3.0, 0);
  const auto parts = splitAtCreases(data);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].points.size(), 16u);
  EXPECT_EQ(parts[1].points.front(), data.points[16]);
  for (const SurfaceData& part : parts) EXPECT_LT(gap(data, part), 1e-15);
}

TEST(SplitAtCreases, PartsInBothDirections) {
  SurfaceData data;
  data.degree = {1, 1};
  data.knots = {std::vector<double>{0, 0, 1, 2, 2}, std::vector<double>{0, 0, 1, 2, 2}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) data.points.emplace_back(i, j, i == 1 && j == 1 ? 1 : 0);
  }
  EXPECT_EQ(splitAtCreases(data).size(), 4u);
}

TEST(SplitAtCreases, SeesACreaseThatOpensOnlyAtOneEnd) {
  SurfaceData data = samples::roof(0);
  for (std::size_t i = 0; i < 3; ++i) data.points[4 * i + 3].z() = -0.01 * static_cast<double>(3 - i);
  EXPECT_EQ(splitAtCreases(data).size(), 2u);
}

TEST(SplitAtCreases, SeesASurfaceThatFoldsBack) {
  SurfaceData data = samples::roof(0);
  for (std::size_t k = 16; k < data.points.size(); ++k) data.points[k].x() *= -1;
  EXPECT_EQ(splitAtCreases(data).size(), 2u);
}

/// A roof of cubic splines with simple knots, of which three rows of control points coincide at the ridge.
SurfaceData tripled(bool rational) {
  SurfaceData data;
  data.degree = {3, 1};
  data.knots = {std::vector<double>{0, 0, 0, 0, .25, .5, .75, 1, 1, 1, 1}, std::vector<double>{0, 0, 1, 1}};
  for (const double x : {-1.0, -0.6, 0.0, 0.0, 0.0, 0.6, 1.0})
    for (const double y : {0.0, 1.0}) {
      data.points.emplace_back(x, y, -std::abs(x));
      if (rational) data.weights.push_back((1 + 0.5 * x) * (1 + y));
    }
  return data;
}

TEST(SplitAtCreases, PartsAtACuspAndLeavesNoPartWithoutATangent) {
  for (const bool rational : {false, true}) {
    const auto parts = splitAtCreases(tripled(rational));
    ASSERT_EQ(parts.size(), 4u) << "two spans beside the ridge, and the rest on either side";
    for (const SurfaceData& part : parts) {
      const Surface surface(part, Form::kNet);
      const auto u = part.domain(0);
      for (const double share : {0.0, 0.3, 0.7, 1.0})
        for (const double v : {0.0, 0.4, 1.0}) {
          SurfacePoint E;
          surface.evaluate1(std::lerp(u[0], u[1], share), v, E);
          EXPECT_NEAR(E.S.z(), -std::abs(E.S.x()), 1e-15);
          EXPECT_NEAR(E.S.y(), v, 1e-15 + (rational ? 1 : 0)) << "weights move the points along the ridge";
          EXPECT_GT(E.Su.norm(), 0.05) << share;
        }
    }
  }
}

TEST(SplitAtCreases, LeavesOutARowThatIsOnlyALine) {
  SurfaceData data = tripled(false);
  data.knots[0] = {0, 0, 0, 0, .2, .4, .6, .8, 1, 1, 1, 1};
  data.points.insert(data.points.begin() + 4, {{0, 0, 0}, {0, 1, 0}});  // four rows: a span is no more than the ridge
  EXPECT_EQ(splitAtCreases(data).size(), 4u);
}

}  // namespace
}  // namespace hapticd::spline
