// SPDX-License-Identifier: MIT
#include "kernels/brep/elements/recognised_edges.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "kernels/brep/elements/pieces.hpp"
#include "kernels/brep/search/search.hpp"
#include "kernels/part/file.hpp"
#include "sample_splines.hpp"

namespace hapticd::brep {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.005, kHeight = 0.02;

/// Returns three quarters of a cylinder's wall as a rational spline. Its edges are two arcs and two lines. @param bulge
/// [m] makes the arcs deviate from circles
spline::SurfaceData wall(double bulge) {
  spline::SurfaceData data;
  data.degree = {2, 1};
  data.knots[0] = {0, 0, 0, 1, 1, 2.5, 2.5, 3, 3, 3};
  data.knots[1] = {0, 0, 1, 1};
  const double half = std::sqrt(0.5);
  for (int i = 0; i < 7; ++i) {
    const double angle = i * std::numbers::pi / 4, r = i % 2 == 0 ? kRadius : kRadius / half + bulge;
    for (const double z : {0.0, kHeight}) {
      data.points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
      data.weights.push_back(i % 2 == 0 ? 1 : half);
    }
  }
  return data;
}

TEST(RecognisedEdges, AreTheLinesAndCirclesTheyAreInTruth) {
  const Part part = samples::sheetOf({wall(0)});
  const Geometry geometry(part, spline::Form::kNet);
  int circles = 0, lines = 0;
  spline::CurvePoint C;
  for (const Edge& edge : part.edges) {
    const auto made = recogniseEdge(geometry, edge);
    ASSERT_TRUE(made);
    ++(made->is_circle ? circles : lines);
    EXPECT_NEAR(made->shape.t1, made->is_circle ? 1.5 * std::numbers::pi : kHeight, 1e-12);
    for (int i = 0; i <= 1000; ++i) {  // parameterAt() must return the parameter of each point
      const double t = edge.t0 + (edge.t1 - edge.t0) * i / 1000;
      geometry.curve(edge.curve, t, C);
      const Vector3d w = C.C - made->shape.o;
      const double angle = std::atan2(w.dot(made->shape.y), w.dot(made->shape.x));
      const double s = made->is_circle ? angle + (angle < -1e-9 ? 2 * std::numbers::pi : 0) : w.dot(made->shape.x);
      EXPECT_NEAR(parameterAt(geometry, *made, s, C.C), t, 1e-11);
    }
  }
  EXPECT_EQ(circles, 2);
  EXPECT_EQ(lines, 2);
}

TEST(RecognisedEdges, AreNotTakenForMoreThanTheyAre) {
  const Part part = samples::sheetOf({wall(1e-9)});  // the arcs deviate from circles by some tenths of a nanometre
  const Geometry geometry(part, spline::Form::kNet);
  int lines = 0;
  for (const Edge& edge : part.edges)
    if (const auto made = recogniseEdge(geometry, edge)) lines += !made->is_circle;
  EXPECT_EQ(lines, 2);
}

/// Returns the number of minima of the distance from p along a piece, including its ends. @param inner becomes the
/// number without the ends
int minima(const Geometry& geometry, const BoxedPiece& made, std::uint32_t curve, const Vector3d& p, int& inner) {
  constexpr int kSamples = 400;
  spline::CurvePoint C;
  int count = 0, sign = -1;
  inner = 0;
  for (int i = 0; i <= kSamples; ++i) {
    const double t0 = made.piece.t0, range = made.piece.t1 - t0;
    geometry.curve(curve, t0 + range * std::min(static_cast<double>(i) / kSamples, 1 - 1e-9),
                   C);  // at a knot, derivatives are evaluated in the span to its right
    const int now = (C.C - p).dot(C.C1) > 0 ? 1 : -1;
    if (sign < 0 && now > 0) ++count, inner += i > 0;
    sign = now;
  }
  return count + (sign < 0 ? 1 : 0);
}

TEST(PieceCurvature, PromisesNoFewerFeetThanThereAre) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const double bulge : {1e-9, 1e-4, -5e-4}) {
    const Part part = samples::sheetOf({wall(bulge)});
    const Geometry geometry(part, spline::Form::kNet);
    int told = 0, all = 0, wrong = 0;
    for (std::uint32_t e = 0; e < part.edges.size(); ++e) {
      std::vector<BoxedPiece> pieces;
      cutEdge(geometry, e, pieces);
      for (const BoxedPiece& made : pieces)
        for (int i = 0; i < 500; ++i, ++all) {
          const double far = std::pow(10.0, -3 + i % 4);
          const Vector3d p = far * Vector3d(normal(random), normal(random), i % 2 * normal(random));
          const FeetOfPiece feet = countFeet(made.piece.curvature, p);
          int inner = 0;
          const int count = minima(geometry, made, part.edges[e].curve, p, inner);
          wrong += (feet == FeetOfPiece::kOne && count != 1) || (feet == FeetOfPiece::kAtAnEnd && inner != 0);
          told += feet != FeetOfPiece::kUnknown;
        }
    }
    std::printf("bulge %g m: %.2f %% of %d told\n", bulge, 100.0 * told / all, all);
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(told, 0.9 * all);
  }
}

/// Regression: the foot on a piece of such a spline was not proved if the probe was beyond the centre of curvature.
/// Each tick then examined all elements that are not farther than the boxes of the pieces, and returned a degraded
/// foot.
TEST(RecognisedEdges, AreProvedFromAfarWithFewFeet) {
  std::ifstream in(HAPTICD_SOURCE_DIR "/config/models/as1.hpart", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const char* instance : {"", "l-bracket-assembly_1", "plate_1", "rod-assembly_1"}) {
    ModelOptions options;
    options.instance = instance;
    const Model model(readPart(std::as_bytes(std::span(bytes)), "as1"), options);
    Search search(model);
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const double size = model.bounds().diagonal().norm();
    int feet = 0, ticks = 0, unproved = 0, most = 0;
    for (int walk = 0; walk < 200; ++walk) {
      const Vector3d out = Vector3d(normal(random), normal(random), normal(random)).normalized();
      const Vector3d way = Vector3d(normal(random), normal(random), normal(random)).normalized() * 1e-4;
      Vector3d p = model.bounds().center() + (0.2 + 0.01 * walk) * size * out;
      for (int i = 0; i < 50; ++i, ++ticks) {
        p += way;
        const Nearest& found = search.nearest(p);
        unproved += !found.proved;
        feet += found.elements;
        most = std::max(most, found.elements);
      }
    }
    EXPECT_EQ(unproved, 0) << instance;
    EXPECT_LT(feet, 8 * ticks) << instance;
    std::printf("'%s': %.1f feet a tick, most %d\n", instance, static_cast<double>(feet) / ticks, most);
  }
}

}  // namespace
}  // namespace hapticd::brep
